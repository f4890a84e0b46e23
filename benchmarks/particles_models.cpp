#include "particles.hpp"

#include <fmt/format.h>

#include <cmath>
#include <random>

namespace bench {
namespace {

constexpr double pi = 3.14159265358979323846;
using Numbers = std::vector<double>;

double kinetic(const double* v, std::size_t n, const double* masses, std::size_t dimensions) {
  double sum = 0;
  for (std::size_t i = 0; i < n; ++i) sum += 0.5 * masses[i / dimensions] * v[i] * v[i];
  return sum;
}

double distance(const double* q, std::size_t i, std::size_t j, std::size_t dimensions) {
  double square = 0;
  for (std::size_t k = 0; k < dimensions; ++k) square += std::pow(q[i * dimensions + k] - q[j * dimensions + k], 2);
  return std::sqrt(square);
}

/// parameters: G, then the masses.
template <std::size_t dimensions>
double gravitation(const Numbers& p, const double* q, const double* v, std::size_t n) {
  double sum = kinetic(v, n, p.data() + 1, dimensions);
  for (std::size_t i = 0; i < n / dimensions; ++i)
    for (std::size_t j = 0; j < i; ++j) sum -= p[0] * p[i + 1] * p[j + 1] / distance(q, i, j, dimensions);
  return sum;
}

std::string start_of(const std::string& names, const Numbers& values, const char* prime = "") {
  std::string out;
  for (std::size_t k = 0; k < values.size(); ++k)
    out += fmt::format("start {}{}{} = {}\n", names[k % names.size()], k / names.size() + 1, prime, values[k]);
  return out;
}

/// Bodies of these masses, with their coordinates one after the other.
Particles gravitating(std::string name, std::string axes, double G, const Numbers& masses, const Numbers& q,
                      const Numbers& v, double time) {
  std::string text = fmt::format("dimensionless\nparam G = {}\n", G), pairs;
  for (std::size_t i = 1; i <= masses.size(); ++i) {
    std::string place;
    for (const char axis : axes) place += fmt::format("{}{}{}", place.empty() ? "" : ", ", axis, i);
    text +=
        fmt::format("param m{0} = {1}\ncoord {2} : number\npoint P{0} mass m{0} at ({2})\n", i, masses[i - 1], place);
    for (std::size_t j = 1; j < i; ++j) pairs += fmt::format("V += -G m{0} m{1}/norm(P{0} - P{1})\n", i, j);
  }
  Numbers parameters{G};
  parameters.insert(parameters.end(), masses.begin(), masses.end());
  return {std::move(name),
          text + pairs + start_of(axes, q) + start_of(axes, v, "'"),
          q,
          v,
          time,
          parameters,
          axes.size() == 2 ? gravitation<2> : gravitation<3>,
          masses.size() * (masses.size() - 1) / 2};
}

std::string list(const char* name, int count) {
  std::string out;
  for (int i = 1; i <= count; ++i) out += fmt::format("{}{}{}", i > 1 ? ", " : "", name, i);
  return out;
}

}  // namespace

Particles kepler() {
  return {"Kepler, e = 0.6",
          "dimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\nV = -1/sqrt(x^2 + y^2)\nstart x = 0.4, y' = 2\n",
          {0.4, 0},
          {0, 2},
          100000,
          {},
          [](const Numbers&, const double* q, const double* v, std::size_t) {
            return 0.5 * (v[0] * v[0] + v[1] * v[1]) - 1 / std::hypot(q[0], q[1]);
          },
          1};
}

Particles henon_heiles() {
  return {"Hénon and Heiles",
          "dimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\nV = 1/2 (x^2 + y^2) + x^2 y - 1/3 y^3\n"
          "start x' = 0.5, y = 0\n",
          {0, 0},
          {0.5, 0},
          100000,
          {},
          [](const Numbers&, const double* q, const double* v, std::size_t) {
            return 0.5 * (v[0] * v[0] + v[1] * v[1] + q[0] * q[0] + q[1] * q[1]) + q[0] * q[0] * q[1] -
                   q[1] * q[1] * q[1] / 3;
          },
          0};
}

Particles outer_solar_system() {
  return gravitating(
      "outer solar system", "xyz", 2.95912208286e-4,
      {1.00000597682, 0.000954786104043, 0.000285583733151, 0.0000437273164546, 0.0000517759138449, 7.692307692e-9},
      {0, 0, 0, -3.5023653, -3.8169847, -1.5507963, 9.0755314, -3.0458353, -1.6483708, 8.3101420, -16.2901086,
       -7.2521278, 11.4707666, -25.7294829, -10.8169456, -15.5387357, -25.2225594, -3.1902382},
      {0, 0, 0, 0.00565429, -0.00412490, -0.00190589, 0.00168318, 0.00483525, 0.00192462, 0.00354178, 0.00137102,
       0.00055029, 0.00288930, 0.00114527, 0.00039677, 0.00276725, -0.00170702, -0.00136504},
      200'000);
}

Particles pleiades() {
  return gravitating("Pleiades", "xy", 1, {1, 2, 3, 4, 5, 6, 7}, {3, 3, 3, -3, -1, 2, -3, 0, 2, 0, -2, -4, 2, 4},
                     {0, 0, 0, 0, 0, 0, 0, -1.25, 0, 1, 1.75, 0, -1.5, 0}, 3);
}

Particles bodies(int count) {
  std::mt19937 random(1);
  const auto within = [&](double size) { return size * (2 * (static_cast<double>(random()) / 4294967296.0) - 1); };
  const int side = static_cast<int>(std::ceil(std::cbrt(count)));
  Numbers q, v;
  for (int i = 0; i < count; ++i)
    for (const int place : {i % side, i / side % side, i / side / side}) {
      q.push_back(2 * (place - 0.5 * (side - 1)) + within(0.3));
      v.push_back(within(0.3));
    }
  return gravitating(fmt::format("{} bodies in space", count), "xyz", 1, Numbers(static_cast<std::size_t>(count), 1.0),
                     q, v, count <= 8 ? 3 : 2);
}

Particles lennard_jones() {
  const double golden = 0.5 * (1 + std::sqrt(5.0)), size = 1.1 / std::hypot(1.0, golden);
  Numbers q{0, 0, 0};
  for (const double a : {1.0, -1.0})
    for (const double b : {golden, -golden})
      for (const Numbers& p : {Numbers{0, a, b}, Numbers{a, b, 0}, Numbers{b, 0, a}})
        for (const double x : p) q.push_back(size * x * (1 + 0.01 * std::sin(7.0 * static_cast<double>(q.size()))));
  std::string text = "dimensionless\n", pairs;
  for (int i = 1; i <= 13; ++i) {
    text += fmt::format("coord x{0}, y{0}, z{0} : number\npoint P{0} mass 1 at (x{0}, y{0}, z{0})\n", i);
    for (int j = 1; j < i; ++j) pairs += fmt::format("V += 4 (1/norm(P{0} - P{1})^12 - 1/norm(P{0} - P{1})^6)\n", i, j);
  }
  return {"13 atoms, Lennard-Jones",
          text + pairs + start_of("xyz", q),
          q,
          Numbers(q.size(), 0.0),
          5,
          Numbers(13, 1.0),
          [](const Numbers& masses, const double* x, const double* v, std::size_t n) {
            double sum = kinetic(v, n, masses.data(), 3);
            for (std::size_t i = 0; i < n / 3; ++i)
              for (std::size_t j = 0; j < i; ++j) {
                const double s = std::pow(distance(x, i, j, 3), -6);
                sum += 4 * (s * s - s);
              }
            return sum;
          },
          78};
}

/// side × side masses that move across their plane, each with springs to its neighbours and k/4 of a cubic one.
Particles spring_lattice(int side) {
  const int count = side * side;
  std::string text = fmt::format("dimensionless\ncoord {} : number\n", list("z", count));
  Numbers q;
  for (int i = 1; i <= count; ++i) {
    q.push_back(std::sin(0.7 * i));
    text += fmt::format("T += 1/2 z{}'^2\n", i);
    for (const int j : {i % side != 0 ? i + 1 : 0, i + side <= count ? i + side : 0})
      if (j != 0) text += fmt::format("V += 1/2 (z{0} - z{1})^2 + 1/4 (z{0} - z{1})^4\n", i, j);
  }
  return {fmt::format("{0} × {0} lattice of springs", side),
          text + start_of("z", q),
          q,
          Numbers(q.size(), 0.0),
          20,
          {static_cast<double>(side)},
          [](const Numbers& p, const double* z, const double* v, std::size_t n) {
            const auto width = static_cast<std::size_t>(p[0]);
            double sum = 0;
            const auto spring = [&](std::size_t i, std::size_t j) {
              const double d = z[i] - z[j];
              sum += 0.5 * d * d + 0.25 * d * d * d * d;
            };
            for (std::size_t i = 0; i < n; ++i) {
              sum += 0.5 * v[i] * v[i];
              if (i % width + 1 < width) spring(i, i + 1);
              if (i + width < n) spring(i, i + width);
            }
            return sum;
          },
          0};
}

Particles toda(int count) {
  std::string text = fmt::format("dimensionless\ncoord {} : number\n", list("q", count));
  Numbers v;
  for (int i = 1; i <= count; ++i) {
    text += fmt::format("T += 1/2 q{0}'^2\nV += exp(q{0} - q{1})\n", i, i % count + 1);
    v.push_back(std::sin(2 * pi * i / count));
  }
  return {fmt::format("Toda's ring of {}", count),
          text + start_of("q", v, "'"),
          Numbers(v.size(), 0.0),
          v,
          20,
          {},
          [](const Numbers&, const double* q, const double* v, std::size_t n) {
            double sum = 0;
            for (std::size_t i = 0; i < n; ++i) sum += 0.5 * v[i] * v[i] + std::exp(q[i] - q[(i + 1) % n]);
            return sum;
          },
          0};
}

Particles fput(int count) {
  std::string text = fmt::format("dimensionless\nparam α = 0.25\ncoord {} : number\n", list("q", count));
  Numbers q;
  for (int i = 0; i <= count; ++i) {
    const std::string left = i > 0 ? fmt::format("q{}", i) : "0", right = i < count ? fmt::format("q{}", i + 1) : "0";
    text += fmt::format("V += 1/2 ({1} - {0})^2 + α/3 ({1} - {0})^3\n", left, right);
    if (i > 0) text += fmt::format("T += 1/2 {}'^2\n", left);
    if (i > 0) q.push_back(std::sin(pi * i / (count + 1)));
  }
  return {fmt::format("Fermi, Pasta, Ulam and Tsingou, {}", count),
          text + start_of("q", q),
          q,
          Numbers(q.size(), 0.0),
          200,
          {0.25},
          [](const Numbers& p, const double* q, const double* v, std::size_t n) {
            double sum = 0;
            for (std::size_t i = 0; i <= n; ++i) {
              const double d = (i < n ? q[i] : 0) - (i > 0 ? q[i - 1] : 0);
              sum += 0.5 * d * d + p[0] / 3 * d * d * d + (i < n ? 0.5 * v[i] * v[i] : 0);
            }
            return sum;
          },
          0};
}

}  // namespace bench
