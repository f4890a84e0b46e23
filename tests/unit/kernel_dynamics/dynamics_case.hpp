#pragma once
#include <maupertuis/forward_dynamics.hpp>

#include "../model_text.hpp"

#include <maupertuis/simulation.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

using namespace maupertuis;

struct Dynamics {
  DynamicsSource source;
  Kernel kernel;
  ForwardDynamics dynamics;

  explicit Dynamics(const EquationsOfMotion& equations, const ForwardDynamicsOptions& options = {})
      : source(dynamics_source(equations)),
        kernel(build_kernel(source.kernel)),
        dynamics(kernel, source.inputs, options) {
    dynamics.set_parameters(source.parameters);
  }
  explicit Dynamics(const std::string& text, const ForwardDynamicsOptions& options = {})
      : Dynamics(ModelText(text).equations, options) {}
  std::size_t n() const { return kernel.freedoms(); }
};

using Numbers = std::vector<double>;

inline Numbers random_numbers(std::size_t n, double size, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-size, size);
  Numbers out(n);
  for (double& x : out) x = uniform(random);
  return out;
}

inline std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

inline double largest(const Numbers& x) {
  double out = 0;
  for (const double v : x) out = std::max(out, std::abs(v));
  return out;
}
