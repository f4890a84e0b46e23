#include "machine_code/llvm/emission.hpp"
#include "machine_code/llvm/emitters.hpp"
#include "machine_code/llvm/sines.hpp"
#include "kernel/straight_line/straight_line.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

/// The nodes of a straight line one after the other, values in registers as far as the compiler keeps them there. Long
/// lines are cut into functions, since the time of a compiler grows faster than a function's length; what one hands to
/// a later one goes through memory. Where that would be waited for, a line is one function after all.
namespace maupertuis::llvm_backend {
namespace {

using llvm::Value;
using straight::Node;
using straight::StraightLine;

/// Nodes and terms of one function, and of all.
constexpr std::size_t most_in_function = 400, most_in_all = 60'000;

/// When numbers are there, in cycles of a Zen 5, were there no lack of units: what of a sum is known last decides how
/// it is added up.
class Timing {
 public:
  explicit Timing(const StraightLine& line) : line_(line), ready_(line.nodes.size(), 0) {
    for (straight::Value v = 0; v < line.nodes.size(); ++v) ready_[v] = ready(line.nodes[v]);
  }

  /// The last product of a sum is not to wait for the one before it.
  bool adds_last_apart(const Node& node) const {
    if (node.last - node.first < 3) return false;
    const int rest = chain(node, node.last - 1), product = term(line_.terms[node.last - 1]);
    return std::max(rest, product + multiplication) + addition < std::max(rest, product) + fused;
  }

 private:
  static constexpr int addition = 2, multiplication = 3, fused = 4, division = 13, angles = 40, root = 20;

  int at(straight::Value v) const { return v == straight::none ? 0 : ready_[v]; }
  /// Of the factors of a term, products of all but the last one included.
  int term(const straight::Term& t) const {
    int out = 0, factors = 0;
    for (const straight::Value v : {t.a, t.b, t.c})
      if (v != straight::none) out = std::max(out, at(v) - (factors++ > 1 ? multiplication : 0));
    return out + (factors > 2 ? multiplication : 0);
  }
  int chain(const Node& node, std::uint32_t last) const {
    int out = 0;
    for (std::uint32_t i = node.first; i < last; ++i)
      out = std::max(out, term(line_.terms[i])) + (i == node.first ? multiplication : fused);
    return out;
  }
  int sum(const Node& node) const {
    if (!adds_last_apart(node)) return chain(node, node.last);
    return std::max(chain(node, node.last - 1), term(line_.terms[node.last - 1]) + multiplication) + addition;
  }

  int ready(const Node& node) const {
    const int operands = std::max({at(node.a), at(node.b), at(node.c)});
    switch (node.what) {
      case Node::Literal:
      case Node::Given:
      case Node::Unit:
        return 0;
      case Node::Sum:
        if (node.b != straight::none) return std::max(sum(node), operands) + division;
        return node.a == straight::none ? sum(node) : std::max(sum(node), at(node.a)) + multiplication;
      case Node::Wide:
      case Node::Magnitudes:
        return chain(node, node.last);
      case Node::Angles:
      case Node::Gather: {
        int out = node.what == Node::Angles ? angles : addition;
        for (std::uint32_t i = node.first; i < node.last; ++i)
          out = std::max(out, at(line_.operands[i]) + (node.what == Node::Angles ? angles : addition));
        return out;
      }
      case Node::Root:
        return operands + root;
      case Node::Call:
        return operands + angles;
      case Node::Larger:
      case Node::Chosen:
      case Node::Sine:
      case Node::Cosine:
      case Node::Lane:
        break;
    }
    return operands + addition;
  }

  const StraightLine& line_;
  std::vector<int> ready_;
};

class LineEmitter {
 public:
  LineEmitter(Emission& out, const StraightLine& line, std::string name, bool is_one_function = false)
      : out_(out),
        b_(out.b),
        line_(line),
        timing_(line),
        name_(std::move(name)),
        is_one_function_(is_one_function),
        real_(out.real(1)),
        values_(line.nodes.size(), nullptr) {}

  void run() {
    cut();
    find_places();
    std::vector<llvm::Function*> functions;
    for (piece_ = 0; piece_ < pieces_; ++piece_) functions.push_back(piece());
    if (pieces_ > 1) call_all(functions);
  }

 private:
  // ------------------------------------------------------------------------------------------------------------ pieces

  bool remade(straight::Value v) const {
    const Node::What what = line_.nodes[v].what;
    return what == Node::Literal || what == Node::Given || what == Node::Unit || what == Node::Lane;
  }
  /// What holds the number: a lane is read from its wide value.
  straight::Value holder(straight::Value v) const { return line_.nodes[v].what == Node::Lane ? line_.nodes[v].a : v; }

  void cut() {
    piece_of_.resize(line_.nodes.size());
    std::size_t length = 0;
    for (std::size_t i = 0; i < line_.nodes.size(); ++i) {
      const Node& node = line_.nodes[i];
      const std::size_t size = remade(static_cast<straight::Value>(i)) ? 0 : 1 + (node.last - node.first);
      if (length + size > most_in_function && !is_one_function_) ++pieces_, length = 0;
      length += size;
      const bool of_angles = node.what == Node::Sine || node.what == Node::Cosine;
      piece_of_[i] = of_angles ? piece_of_[node.a] : pieces_;
    }
    ++pieces_;
  }

  /// Of values that a later piece reads. Stores and checks are made where their value is, guarded stores in the last
  /// piece.
  void find_places() {
    place_.assign(line_.nodes.size(), 0);
    std::int64_t next = 8;
    const auto use = [&](straight::Value v, std::size_t piece) {
      v = holder(v);
      if (remade(v) || place_[v] != 0 || piece_of_[v] == piece) return;
      place_[v] = next;
      next += line_.width(v);
    };
    for (std::size_t i = 0; i < line_.nodes.size(); ++i) {
      const Node& node = line_.nodes[i];
      if (node.what == Node::Sine || node.what == Node::Cosine || node.what == Node::Lane) continue;
      straight::for_operands(line_, node, [&](straight::Value v) { use(v, piece_of_[i]); });
    }
    checks_in_.resize(pieces_), finite_in_.resize(pieces_), stores_of_.resize(line_.nodes.size());
    const auto piece_of = [&](straight::Value v) { return remade(holder(v)) ? pieces_ - 1 : piece_of_[holder(v)]; };
    for (const auto& check : line_.checks) {
      const std::size_t piece = std::max(piece_of(check.pivot), piece_of(check.size));
      use(check.pivot, piece), use(check.size, piece);
      checks_in_[piece].push_back(&check);
    }
    for (const auto& store : line_.stores) {
      if (line_.guarded)
        use(store.value, pieces_ - 1);
      else
        stores_of_[holder(store.value)].push_back(&store);
    }
    for (const straight::Value v : line_.finite) finite_in_[piece_of(v)].push_back(v);
  }

  std::vector<llvm::Type*> parameters() { return std::vector<llvm::Type*>(line_.arrays + 1, out_.pointer()); }

  llvm::Function* piece() {
    llvm::Function* const f =
        pieces_ == 1 ? function(name_, true) : function(name_ + "_" + std::to_string(piece_), false);
    arrays_.clear();
    for (llvm::Argument& argument : f->args()) arrays_.push_back(&argument);
    std::fill(values_.begin(), values_.end(), nullptr);
    for (straight::Value v = 0; v < line_.nodes.size(); ++v)
      if (remade(v) ? piece_ + 1 == pieces_ : piece_of_[v] == piece_) define(v), store(v);
    if (line_.guarded && piece_ + 1 == pieces_) {
      close_guarded();
    } else {
      leave_verdict();
      if (line_.guarded)
        b_.CreateRet(b_.getInt8(0));
      else
        out_.end_function();
    }
    return f;
  }

  /// All pieces of a line are of one type. In a long one stores keep loads where they are wanted: moved to the front,
  /// they would fill the registers.
  llvm::Function* function(const std::string& name, bool exported) {
    llvm::Function* const f = out_.function(name, parameters(), exported, line_.guarded ? b_.getInt8Ty() : nullptr);
    for (llvm::Argument& argument : f->args())
      if (line_.guarded || is_one_function_) argument.removeAttr(llvm::Attribute::NoAlias);
    return f;
  }

  /// As soon as it is there, so that it need not be kept.
  void store(straight::Value v) {
    for (const straight::Store* store : stores_of_[v]) put(get(store->value), store->array, store->index);
  }

  /// What is given is read before the first result is stored.
  void close_guarded() {
    for (const straight::Store& store : line_.stores)
      if (remade(store.value)) get(store.value);
    const auto [margin, sum] = verdict();
    Value* const sound = b_.CreateAnd(b_.CreateFCmpOGT(margin, number(0)), b_.CreateFCmpOEQ(sum, number(0)));
    out_.when(sound, [this] {
      for (const straight::Store& store : line_.stores) put(get(store.value), store.array, store.index);
    });
    b_.CreateRet(b_.CreateZExt(sound, b_.getInt8Ty()));
  }

  void call_all(const std::vector<llvm::Function*>& functions) {
    const llvm::Function* const whole = function(name_, true);
    std::vector<Value*> arguments;
    for (unsigned i = 0; i <= line_.arrays; ++i) arguments.push_back(whole->getArg(i));
    Value* result = nullptr;
    for (llvm::Function* const f : functions) result = b_.CreateCall(f, arguments);
    if (line_.guarded)
      b_.CreateRet(result);
    else
      out_.end_function();
  }

  /// See straight::sound. So far, if later pieces have more to say.
  std::pair<Value*, Value*> verdict() {
    Value* margin = number(std::numeric_limits<double>::infinity());
    if (piece_ > 0) margin = fetch(real_, line_.arrays, 0);
    Value* sums[4] = {number(0), number(0), number(0), number(0)};
    if (piece_ > 0) sums[0] = fetch(real_, line_.arrays, 1);
    Value *wide_margin = nullptr, *wide_sum = nullptr;
    std::uint64_t lanes = 0;
    std::size_t turn = 0;
    const auto require_finite = [&](Value* x) {
      Value*& sum = sums[turn++ % 4];
      sum = out_.fma(x, number(0), sum);
    };
    for (const straight::PivotCheck* check : checks_in_[piece_]) {
      llvm::Type* const type = type_of(check->pivot);
      Value* const now = out_.fma(out_.number(-check->share, type), as(type, check->size), get(check->pivot));
      if (type == real_) {
        margin = lesser(now, margin);
        require_finite(now);
        continue;
      }
      lanes = line_.width(check->pivot);
      wide_margin = wide_margin ? lesser(now, wide_margin) : now;
      Value* const none = out_.number(0, type);
      wide_sum = out_.fma(now, none, wide_sum ? wide_sum : none);
    }
    for (const straight::Value v : finite_in_[piece_]) require_finite(get(v));
    for (std::uint64_t lane = 0; lane < lanes; ++lane) {
      margin = lesser(b_.CreateExtractElement(wide_margin, lane), margin);
      require_finite(b_.CreateExtractElement(wide_sum, lane));
    }
    return {margin, turn == 0 ? sums[0] : out_.add(out_.add(sums[0], sums[1]), out_.add(sums[2], sums[3]))};
  }

  void leave_verdict() {
    if (piece_ > 0 && checks_in_[piece_].empty() && finite_in_[piece_].empty()) return;
    const auto [margin, sum] = verdict();
    put(margin, line_.arrays, 0);
    put(sum, line_.arrays, 1);
  }

  Value* lesser(Value* x, Value* y) { return b_.CreateSelect(b_.CreateFCmpOLT(x, y), x, y); }

  // ------------------------------------------------------------------------------------------------------------ values

  llvm::Type* type_of(straight::Value v) { return out_.real(static_cast<int>(line_.width(v))); }
  Value* number(double x) { return out_.number(x, real_); }
  /// The same in all lanes, where `type` is wide and the value is not.
  Value* as(llvm::Type* type, straight::Value v) {
    Value* const x = get(v);
    return x->getType() == type ? x : out_.splat(x, type);
  }

  Value* address(std::uint32_t array, std::int64_t index) { return out_.at(arrays_[array], 8 * index); }
  Value* fetch(llvm::Type* type, std::uint32_t array, std::int64_t index) {
    return b_.CreateAlignedLoad(type, address(array, index), llvm::Align(8));
  }
  void put(Value* x, std::uint32_t array, std::int64_t index) {
    b_.CreateAlignedStore(x, address(array, index), llvm::Align(8));
  }

  Value* get(straight::Value v) {
    if (values_[v]) return values_[v];
    const Node& node = line_.nodes[v];
    switch (node.what) {
      case Node::Literal:
        return values_[v] = number(node.literal);
      case Node::Given:
        return given(v);
      case Node::Lane:
        return values_[v] = lane(node);
      case Node::Unit:
        if (line_.width(v) == 1) return values_[v] = number(1);
        return values_[v] = b_.CreateInsertElement(out_.number(0, type_of(v)), number(1), std::uint64_t{node.index});
      case Node::Sum:
      case Node::Magnitudes:
      case Node::Larger:
      case Node::Chosen:
      case Node::Angles:
      case Node::Sine:
      case Node::Cosine:
      case Node::Root:
      case Node::Call:
      case Node::Wide:
      case Node::Gather:
        break;
    }
    if (place_[v] == 0) throw std::logic_error("a number is read before it is there; please report");
    return values_[v] = fetch(type_of(v), line_.arrays, place_[v]);
  }

  /// What is kept through a long function would be written to the stack, and read again from there.
  Value* given(straight::Value v) {
    Value* const x = fetch(type_of(v), line_.nodes[v].array, line_.nodes[v].index);
    return is_one_function_ ? x : values_[v] = x;
  }

  /// Of a wide value in memory that number alone.
  Value* lane(const Node& node) {
    if (!values_[node.a] && place_[node.a] != 0) return fetch(real_, line_.arrays, place_[node.a] + node.index);
    Value* const all = get(node.a);  // wide values of one number are no vectors
    return all->getType()->isVectorTy() ? b_.CreateExtractElement(all, std::uint64_t{node.index}) : all;
  }

  void keep(straight::Value v, Value* x) {
    values_[v] = x;
    if (place_[v] != 0) put(x, line_.arrays, place_[v]);
  }

  void define(straight::Value v) {
    const Node& node = line_.nodes[v];
    switch (node.what) {
      case Node::Sum:
        return keep(v, scaled(node, sum(node, type_of(v)), type_of(v)));
      case Node::Magnitudes:
        return keep(v, magnitudes(node, type_of(v)));
      case Node::Larger:
        return keep(v, larger(out_.absolute(as(type_of(v), node.a)), out_.absolute(as(type_of(v), node.b))));
      case Node::Chosen:
        return keep(v, b_.CreateSelect(b_.CreateFCmpUNE(get(node.a), number(0)), get(node.b), get(node.c)));
      case Node::Angles:
        return angles(v);
      case Node::Root:
        return keep(v, out_.square_root(get(node.a)));
      case Node::Call:
        return keep(v, out_.elementary(node.function, get(node.a), node.b == straight::none ? nullptr : get(node.b)));
      case Node::Wide:
        return keep(v, wide(node, type_of(v)));
      case Node::Gather:
        return keep(v, gathered(node, type_of(v)));
      case Node::Sine:
      case Node::Cosine:
        return;  // they come with their angles
      case Node::Literal:
      case Node::Given:
      case Node::Lane:
      case Node::Unit:
        return;
    }
  }

  Value* gathered(const Node& node, llvm::Type* type) {
    if (!type->isVectorTy()) return get(line_.operands[node.first]);
    if (Value* const all = shuffled(node)) return all;
    Value* out = llvm::PoisonValue::get(type);
    for (std::uint32_t i = node.first; i < node.last; ++i)
      out = b_.CreateInsertElement(out, fresh(line_.operands[i]), std::uint64_t{i - node.first});
    return out;
  }

  /// Lanes of one or two values; null: of others.
  Value* shuffled(const Node& node) {
    std::vector<straight::Value> sources;
    std::vector<int> mask;
    for (std::uint32_t i = node.first; i < node.last; ++i) {
      const Node& lane = line_.nodes[line_.operands[i]];
      if (lane.what != Node::Lane || line_.width(lane.a) != line_.width(line_.nodes[line_.operands[node.first]].a))
        return nullptr;
      const auto found = std::find(sources.begin(), sources.end(), lane.a);
      const auto source = static_cast<std::uint32_t>(found - sources.begin());
      if (found == sources.end()) sources.push_back(lane.a);
      mask.push_back(static_cast<int>(source * line_.width(lane.a) + lane.index));
    }
    if (sources.size() > 2) return nullptr;
    return b_.CreateShuffleVector(get(sources[0]), get(sources.back()), mask);
  }

  Value* larger(Value* x, Value* y) { return b_.CreateSelect(b_.CreateFCmpOGT(x, y), x, y); }

  // -------------------------------------------------------------------------------------------------------------- sums

  /// All but the last of the values of a term, and the last.
  std::pair<Value*, Value*> halves(const straight::Term& t, llvm::Type* type, bool positive) {
    std::vector<Value*> factors;
    const double factor = positive ? std::abs(t.factor) : t.factor;
    for (const straight::Value v : {t.a, t.b, t.c})
      if (v != straight::none) factors.push_back(as(type, v));
    if (factors.empty()) return {nullptr, out_.number(factor, type)};
    Value* const last = factors.back();
    factors.pop_back();
    Value* head = nullptr;
    for (Value* const x : factors) head = head ? out_.multiply(head, x) : x;
    if (std::abs(factor) != 1)
      head = head ? out_.multiply(head, out_.number(factor, type)) : out_.number(factor, type);
    else if (factor < 0)
      head = head ? out_.negate(head) : out_.number(-1, type);
    return {head, last};
  }

  Value* sum(const Node& node, llvm::Type* type) {
    Value *out = nullptr, *apart = nullptr;
    const bool in_two = timing_.adds_last_apart(node);
    for (std::uint32_t i = node.first; i < node.last; ++i) {
      const straight::Term& t = line_.terms[i];
      if (in_two && i + 1 == node.last) apart = std::exchange(out, nullptr);
      const auto [head, last] = halves(t, type, false);
      const bool sign = t.b == straight::none && t.factor == -1;
      if (!out)
        out = !head ? last : sign ? out_.negate(last) : out_.multiply(head, last);
      else if (!head)
        out = out_.add(out, last);
      else
        out = sign ? out_.subtract(out, last) : out_.fma(head, last, out);
    }
    return apart ? out_.add(apart, out) : out;
  }

  Value* scaled(const Node& node, Value* x, llvm::Type* type) {
    if (node.a != straight::none) x = out_.multiply(x, as(type, node.a));
    return node.b == straight::none ? x : out_.divide(x, as(type, node.b));
  }

  Value* magnitudes(const Node& node, llvm::Type* type) {
    Value* out = out_.number(0, type);
    for (std::uint32_t i = node.first; i < node.last; ++i) {
      const auto [head, last] = halves(line_.terms[i], type, true);
      out = out_.add(out, out_.absolute(head ? out_.multiply(head, last) : last));
    }
    return out;
  }

  Value* wide(const Node& node, llvm::Type* type) {
    Value* out = nullptr;
    for (std::uint32_t i = node.first; i < node.last; ++i) {
      const straight::Term& t = line_.terms[i];
      Value* const last = get(t.c);
      Value* head = t.a == straight::none ? number(t.factor) : get(t.a);
      if (t.a != straight::none && t.factor != 1)
        head = t.factor == -1 ? out_.negate(head) : out_.multiply(head, number(t.factor));
      Value* const many = out_.splat(head, type);
      out = out ? out_.fma(many, last, out) : out_.multiply(many, last);
    }
    return out ? out : out_.number(0, type);
  }

  // ------------------------------------------------------------------------------------------------------------- sines

  /// What the caller has perhaps just written is read number by number: a wider load would wait until all of it is in
  /// the cache. `volatile` keeps LLVM from joining them.
  Value* fresh(straight::Value v) {
    const Node& node = line_.nodes[v];
    if (node.what != Node::Given) return get(v);
    llvm::LoadInst* const load = b_.CreateAlignedLoad(real_, address(node.array, node.index), llvm::Align(8));
    load->setVolatile(true);
    return load;
  }

  /// All in one vector.
  void angles(straight::Value v) {
    const Node& node = line_.nodes[v];
    const std::uint32_t count = node.last - node.first;
    int width = 1;
    while (width < static_cast<int>(count)) width *= 2;
    llvm::Type* const type = out_.real(width);
    Value* x = out_.number(0, type);
    for (std::uint32_t i = 0; i < count; ++i) {
      const straight::Value angle = line_.operands[node.first + i];
      x = width == 1 ? get(angle) : b_.CreateInsertElement(x, fresh(angle), std::uint64_t{i});
    }
    const auto called = [&] { return out_.sincos(x); };
    const auto [sine, cosine] = out_.features.fma ? sines_in_place(b_, x, called) : called();
    for (straight::Value w = v + 1; w < line_.nodes.size(); ++w) {
      const Node& lane = line_.nodes[w];
      if (lane.a != v || (lane.what != Node::Sine && lane.what != Node::Cosine)) continue;
      Value* const all = lane.what == Node::Sine ? sine : cosine;
      keep(w, width == 1 ? all : b_.CreateExtractElement(all, std::uint64_t{lane.index}));
    }
  }

  Emission& out_;
  llvm::IRBuilder<>& b_;
  const StraightLine& line_;
  Timing timing_;
  std::string name_;
  bool is_one_function_;
  llvm::Type* real_;
  std::size_t pieces_ = 0, piece_ = 0;
  std::vector<std::size_t> piece_of_;                                // [nodes]
  std::vector<std::int64_t> place_;                                  // [nodes] in scratch; 0: none
  std::vector<std::vector<const straight::PivotCheck*>> checks_in_;  // [pieces]
  std::vector<std::vector<const straight::Store*>> stores_of_;       // [nodes] of it or of its lanes
  std::vector<std::vector<straight::Value>> finite_in_;
  std::vector<Value*> arrays_;
  std::vector<Value*> values_;  // [nodes] of this piece
};

}  // namespace

void emit_as_one_function(Emission& out, const StraightLine& line, const std::string& name) {
  LineEmitter(out, line, name, true).run();
}

void emit_straight_lines(Emission& out, const machine_code::Request& request) {
  const auto& lines = *static_cast<const std::vector<StraightLine>*>(request.source);
  std::size_t size = 0;
  for (const StraightLine& line : lines) size += line.size();
  if (size > most_in_all) throw Declined("the program is too long to be written out as machine code");
  for (std::size_t i = 0; i < lines.size(); ++i) LineEmitter(out, lines[i], "line" + std::to_string(i)).run();
}

}  // namespace maupertuis::llvm_backend
