#pragma once
#include <maupertuis/kernel.hpp>

#include <cstddef>
#include <memory>
#include <span>

/// Accelerations and forces at a point, for controllers and simulators with methods of their own.
///
///     ForwardDynamics dynamics(kernel, inputs);      // inputs: which parameters of the kernel change from call to
///     call dynamics.set_parameters(values); if (dynamics.accelerations(t, q, v, u, a) != KernelStatus::Ok) …
///
/// docs/design/forward_dynamics.md tells how; `dynamics_source` (simulation.hpp) makes the kernel's source from a
/// model.
namespace maupertuis {

/// What carries the calls out. Compiled code is straight-line machine code for one kernel and one order of elimination.
struct ForwardDynamicsOptions {
  /// Automatic: compiled where `expected_calls` pay for the compilation, so that equal programs give equal results to
  /// the bit.
  Backend backend = Backend::Automatic;
  double expected_calls = 0;  // of accelerations, forces and bias together
  bool cache = true;          // of compiled code
};

/// R(q,q̇,q̈,u,t) = M(q,t) q̈ + h(q,q̇,u,t) of a kernel. One thread at a time; as many objects as wanted for one kernel.
/// Units are those of the kernel: row i of R has the unit of energy per unit of q_i. Contacts and friction of a model
/// are no part of a kernel: dynamics_source refuses such models. Lists of another length than the comments say:
/// std::invalid_argument, which names them.
class ForwardDynamics {
 public:
  /// `inputs`: parameters of the kernel whose values each call is given.
  explicit ForwardDynamics(const Kernel& kernel, std::span<const std::size_t> inputs = {},
                           const ForwardDynamicsOptions& options = {});
  ~ForwardDynamics();
  ForwardDynamics(ForwardDynamics&&) noexcept;

  /// All parameters of the kernel, the inputs among them (typical values: they do not stay). Constant sub-expressions
  /// and the order of elimination are found here, and what is to be compiled is (10 ms and 20 µs a term; from the cache
  /// 1 ms; not again where only numbers change): never in a call. [parameters of the kernel]
  void set_parameters(std::span<const double> values);
  /// From then on values are those of these sides of the switch functions [switches], as
  /// KernelWorkspace::set_branches. Without it, and after an empty list, each call is answered on the sides that hold
  /// at its point: of a sign at its zero with 0. A point at which a switch function has no value is NonFinite.
  void set_branches(std::span<const std::int8_t> sides);

  /// q̈ [n] with R = 0, given q [n], q̇ [n], u [inputs]. Without constraints nothing is allocated, unless M is so close
  /// to singular that the full matrix has to decide. With constraints by a KernelWorkspace: q̈ obeys them. Errors: as
  /// KernelWorkspace::evaluate. Cost: about one evaluation of R, and of M as far as it is not zero.
  KernelStatus accelerations(double t, std::span<const double> q, std::span<const double> v, std::span<const double> u,
                             std::span<double> a);
  /// Inverse dynamics: R(q,q̇,q̈,u,t) [n], the generalized forces that are missing for the motion to have the
  /// accelerations a; NaN where one of them has no value, as of `bias`.
  void forces(double t, std::span<const double> q, std::span<const double> v, std::span<const double> a,
              std::span<const double> u, std::span<double> out);
  /// h = R(q,q̇,0,u,t) [n]
  void bias(double t, std::span<const double> q, std::span<const double> v, std::span<const double> u,
            std::span<double> out);
  /// M [n × n], row by row, on the sides that hold. Where it depends on an input, on that of the last call or
  /// set_parameters.
  void mass(double t, std::span<const double> q, std::span<const double> v, std::span<double> out);
  /// After SingularMass.
  std::size_t singular_coordinate() const;
  /// Whether machine code is in use, and why not where it was wanted: without LLVM, with constraints, or for programs
  /// too long to be written out the interpreter goes on. Results of both agree to rounding; small pivots are left to
  /// the interpreter.
  const CompileReport& compile_report() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace maupertuis
