#pragma once
#include <string>
#include <vector>

namespace bench {

/// A system of particles as a person writes it, and the closed form of its energy.
struct Particles {
  std::string name, text;
  std::vector<double> q, v;        // the start that the text says
  double time;                     // of the motion that is measured
  std::vector<double> parameters;  // of `energy`
  double (*energy)(const std::vector<double>& parameters, const double* q, const double* v, std::size_t n);
  std::size_t pairs;  // that act on each other; 0: not counted
};

Particles kepler();              // e = 0.6, a period of 2π
Particles henon_heiles();        // E = 1/8
Particles outer_solar_system();  // Hairer, Lubich, Wanner, Geometric Numerical Integration, I.2.4: AU, days
Particles pleiades();            // Hairer, Nørsett, Wanner, Solving Ordinary Differential Equations I, II.10
Particles bodies(int count);     // in space, each of mass 1, near the points of a lattice
Particles lennard_jones();       // 13 atoms near the icosahedron
Particles spring_lattice(int side);
Particles toda(int count);  // a ring
Particles fput(int count);  // α = 0.25, both ends held

}  // namespace bench
