#pragma once
#include <maupertuis/backend.hpp>
#include <maupertuis/expression.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

/// From expressions to numbers: a Kernel is an immutable straight-line program, a KernelWorkspace runs it.
///
///     KernelSource source;
///     source.coordinates = {q};  source.parameters = {k};  source.residual = {m * a + k * q};
///     Kernel kernel = build_kernel(source);
///     KernelWorkspace work(kernel, 20);
///     work.set_parameters(values);
///     if (work.expand(t, q0, v0) == KernelStatus::Ok) ... work.coordinate(k)[i] ...
///
/// docs/design/kernel_program.md tells how; nothing here knows mechanics.
namespace maupertuis {

/// f(q, t) = 0 (level 0) or f(q, q̇, t) = 0 (level 1) along the motion. Its row of A is ∂f/∂q or ∂f/∂q̇.
struct KernelConstraint {
  Expr value;
  int level = 0;
  std::string name;  // for messages
};

/// What a kernel is built from. The expressions may hold TimeDerivative nodes, t, numbers, and symbols of the listed
/// coordinates (orders 0, 1, 2), multipliers and parameters; every other symbol (inputs, lets) is already substituted.
struct KernelSource {
  std::vector<Expr> coordinates;              // [n] symbols of order 0
  std::vector<Expr> parameters;               // [p] symbols of Role::Parameter or Role::Constant
  std::vector<Expr> residual;                 // [n] R(q,q̇,q̈,λ,t) = 0, linear in q̈ and λ; M = ∂R/∂q̈
  std::vector<Expr> multipliers;              // [m] symbols of the unknown λ, one a constraint
  std::vector<KernelConstraint> constraints;  // [m]
  std::vector<Expr> observables;              // numbers wanted at points of the motion
  std::vector<Expr> events;                   // functions whose roots are to be located
  std::vector<Expr> integrands;               // functions whose integrals over time are wanted (work, action)
};

/// A function whose zero changes the formula in force: the argument of abs, sign or step, the difference of the
/// arguments of min, max or a comparison, y of atan2(y, x).
struct SwitchFunction {
  Kind kind = Kind::Abs;  // what it first stood in: Abs, Sign, Step, Min, Max, Less, LessEqual, Atan2 (its cut)
  Expr left, right;       // the function is left − right; `right` is empty for Abs, Sign, Step
};

struct Program;

/// An immutable compiled system; cheap to copy, safe to share between threads.
class Kernel {
 public:
  explicit Kernel(std::shared_ptr<const Program> program) : program_(std::move(program)) {}

  std::size_t freedoms() const;
  std::size_t constraints() const;
  std::size_t parameters() const;
  std::size_t observables() const;
  std::size_t events() const;
  std::size_t integrands() const;
  std::span<const SwitchFunction> switches() const;
  /// The coordinate's name, for messages.
  const std::string& coordinate_name(std::size_t index) const;
  const std::string& constraint_name(std::size_t index) const;
  /// Of one motion, from which on compiling the code of a stage takes less time than it saves beside the interpreter,
  /// on the vectors that are used here.
  double steps_that_repay_code() const;
  /// One line an instruction: `maup derive --emit program`.
  std::string print() const;

  const Program& program() const { return *program_; }

 private:
  std::shared_ptr<const Program> program_;
};

/// Lowers expressions to a program. Cost about linear in the number of nodes.
/// Throws std::invalid_argument for a symbol that the source does not list, for a residual that is not linear in q̈, and
/// for a third derivative of a coordinate.
Kernel build_kernel(const KernelSource& source);

/// How a compilation went.
struct CompileReport {
  bool compiled = false;
  std::string trouble;          // one sentence where it is not
  std::string cache_trouble{};  // the code is there, but could not be kept for the next run
  bool from_cache = false;
  bool is_final = true;  // no better code of the same results follows
  double seconds = 0;
};

enum class KernelStatus {
  Ok,
  SingularMass,   // M has no reliable inverse here: `singular_coordinate` is a coordinate whose q̈ is not determined
  Contradiction,  // the constraints ask for accelerations that exclude each other: `contradicting_constraint` is one of
                  // them
  NonFinite,      // a value is infinite or undefined
};

/// Of Taylor polynomials c_0 + c_1 τ + … beside each other, coefficient k of column i at first[k · stride + i]: what is
/// to be added to c_1 and c_1 after τ, Σ_{k≥2} c_k τ^{k−1} and Σ_{k≥2} k c_k τ^{k−1}. Rows and results are read and
/// written in eights.
using PolynomialIncrements = void(const double* first, std::size_t stride, std::size_t columns, int degree, double tau,
                                  double* dq, double* dv);
PolynomialIncrements polynomial_increments;
/// Σ_{k≥2} k (k − 1) c_k τ^{k−2} of the same polynomials; written in eights.
using PolynomialAccelerations = void(const double* first, std::size_t stride, std::size_t columns, int degree,
                                     double tau, double* a);
PolynomialAccelerations polynomial_accelerations;
/// Σ_{k≥1} w_k |c_k| of each column for three rows of weights [3][degree + 1]; sizes: [3][columns], rounded up to
/// eights.
void polynomial_sizes(const double* first, std::size_t stride, std::size_t columns, int degree, const double* weights,
                      double* sizes);
/// Σ_{k≥1} |c_k| r^k, Σ k |c_k| r^{k−1} and Σ k (k − 1) |c_k| r^{k−2}: [3][columns], with room for a fourth row.
using PolynomialSizes = void(const double* first, double radius, double* sizes);
/// For any number of columns and any degree, or as code for those of one workspace.
struct Polynomials {
  PolynomialIncrements* increments = polynomial_increments;
  PolynomialAccelerations* accelerations = polynomial_accelerations;
  PolynomialSizes* sizes = nullptr;  // code alone
};
/// q += (dq + q̇) τ and q̇ += dv with compensation: q and q̇ are sums hi + lo, pair by pair [count][2]. Results may take
/// the place of what they come from.
void add_increments(std::size_t count, double tau, const double* dq, const double* dv, const double* q, const double* v,
                    double* q_out, double* v_out);

/// Everything that a run of a kernel changes. One thread at a time; as many as wanted for one kernel.
///
/// Coefficients are normalized: x(t + τ) = Σ x_k τ^k.
class KernelWorkspace {
 public:
  /// `order`: of the Taylor polynomial of q̇ (≥ 1); that of q is one higher.
  KernelWorkspace(const Kernel& kernel, int order);
  ~KernelWorkspace();
  KernelWorkspace(KernelWorkspace&&) noexcept;

  int order() const;
  /// Precondition: values.size() == kernel.parameters(). Constant sub-expressions are computed here, once.
  void set_parameters(std::span<const double> values);
  /// Accelerations [n] that forces cause elsewhere in the motion, or none: where they balance, what they leave of
  /// dependent rows of A is rounding of these.
  void set_usual_accelerations(std::span<const double> accelerations);
  /// Which side of its zero each switch function is taken to be on: +1, −1, or 0 (it vanishes identically).
  /// [switches]; initially +1. Values are those of these sides wherever the point lies: choose_branches for others.
  void set_branches(std::span<const std::int8_t> sides);
  /// Sets the branches that hold at a point: the side of its zero on which each switch function is there, 0 where it
  /// vanishes. False: one of them has no value. Cost: some evaluations, one more than functions stand within each
  /// other.
  bool choose_branches(double t, std::span<const double> q, std::span<const double> v);
  std::span<const std::int8_t> branches() const;

  /// The Taylor coefficients of the motion through (t, q, q̇) under the branches set, and of the switch functions,
  /// events and integrands along it; observables at (t, q, q̇) itself.
  ///
  /// Order by order: residual with q̈_k = 0 and λ_k = 0, solve M₀ q̈_k = −R_k with the one factorization of M₀ (bordered
  /// by A where there are constraints), correct by tangents. Cost O(order² · program + order · (n + m)² + (n + m)³).
  /// Where rows of A depend on others, an independent set of them is kept for all orders.
  KernelStatus expand(double t, std::span<const double> q, std::span<const double> v);
  /// The same up to q̈ and the observables alone.
  KernelStatus evaluate(double t, std::span<const double> q, std::span<const double> v);
  /// After `evaluate` without a solution: observables that need no q̈ and no λ have their values, the others are NaN.
  void observe_without_solution();

  /// The k-th coefficients of q [n], 0 ≤ k ≤ order + 1 (after `evaluate` k ≤ 2).
  const double* coordinate(int k) const;
  /// q̈ at the point, q̈_i = 2 · coordinate(2)[i].
  double acceleration(std::size_t i) const;
  double observable(std::size_t i) const;
  /// λ_i at the point, and whether the equations determine it: not where its row of A depends on others.
  double multiplier(std::size_t i) const;
  bool multiplier_is_determined(std::size_t i) const;
  /// f_i of a constraint of level 0 at the point (0 for level 1), and df_i/dt or f_i of level 1; the sizes of the terms
  /// that add up to the latter two.
  double constraint_value(std::size_t i) const;
  double constraint_rate(std::size_t i) const;
  double constraint_scale(std::size_t i) const;
  double constraint_rate_scale(std::size_t i) const;
  /// The smallest changes of q and q̇, in the metric M, that bring the constraints back to zero, to first order.
  /// [n] each. Precondition: the last call returned Ok.
  void corrections(std::span<double> dq, std::span<double> dv);
  /// How far the factored matrix is from a singular one: its smallest pivot against the largest, 1 without constraints.
  /// It falls towards 0 next to a singular configuration of the constraints, and λ and q̈ lose digits with it.
  double pivot_ratio() const;
  /// The number of constraints whose rows of A are in force.
  std::size_t constraints_in_force() const;
  /// M and A at the point, whatever the status.
  double mass(std::size_t i, std::size_t j) const;
  double constraint_matrix(std::size_t constraint, std::size_t coordinate) const;
  /// A coefficient of a function along the motion; zero beyond the orders that are known.
  double switch_function(std::size_t i, int k) const;
  double event(std::size_t i, int k) const;
  double integrand(std::size_t i, int k) const;
  /// Sizes of the terms that add up to the switch function or event at the point: what its rounding error is
  /// measured against.
  double switch_scale(std::size_t i) const;
  double event_scale(std::size_t i) const;
  /// After SingularMass.
  std::size_t singular_coordinate() const;
  /// After Contradiction.
  std::size_t contradicting_constraint() const;

  /// From then on `expand` runs machine code: with `long_run` straight-line code for the whole expansion of a small
  /// program without constraints, else code for one stage; where M₀ is solved along its sparse graph those solutions
  /// are code then. Where the program is too large or LLVM is not there, the interpreter goes on, and the report says
  /// why. Results agree to rounding. `in_tiers`: straight-line code of up to 8 unknowns is compiled in a quarter of the
  /// time first, and in a second thread with all passes when it was run 200,000 times; both give the same bits. Cost:
  /// straight-line code about 0.2 s, else some 15 ms and half a millisecond an unknown; from the cache 1 ms.
  CompileReport compile(const CompileOptions& options = {});

  /// The radius of convergence that the last coefficients of q tell: with v_k = (k + 1) |q_{k+1}| and s_i the largest
  /// of v_k h^k for k ≤ 3 and ε |q_0| / h, the least of (s_i / v_k)^{1/k} over all coordinates and the last six k,
  /// where the last two are taken as they are and the others times 1.25. To 5·10⁻⁴/k + 10⁻⁴, k being the one that
  /// decides; infinite where all these v_k vanish; not a number where some s_i is 0 (or nearly so): no estimate.
  double radius(double h) const;
  /// For the coefficients coordinate(k), k ≤ order + 1, until the next `compile`; accelerations for copies of these of
  /// any stride, until the one after it.
  Polynomials polynomials() const;
  /// Doubles from one order of coordinate() to the next.
  std::size_t row_stride() const;
  /// The program that is run: that of the kernel, with slots numbered anew. Coefficient k of slot s is
  /// coordinate(k)[s].
  const Program& program() const;
  /// [program().constants] under the parameters and sides of the last expansion.
  const double* constants() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace maupertuis
