#include "kernel/llvm/emission.hpp"
#include "kernel/llvm/emitters.hpp"
#include "kernel/llvm/sines.hpp"
#include "kernel/llvm/trial_lowering.hpp"
#include "kernel/packed/code.hpp"

#include <cstdlib>
#include <optional>

namespace maupertuis::llvm_backend {
namespace {

using grouped::Entry;
using grouped::Line;
using grouped::Node;
using grouped::Number;
using llvm::Value;

class GroupedEmitter {
 public:
  GroupedEmitter(Emission& out, const Line& line) : out_(out), b_(out.b), line_(line), values_(line.entries.size(), nullptr), places_(line.entries.size()), scratch_of_(line.entries.size(), false) {
    if (const char* const f = std::getenv("MAUP_FAR")) far_ = std::atoi(f);
  }

  void run() {
    f_ = out_.function("expand", {out_.pointer()}, true, b_.getInt32Ty());
    const auto field = [&](std::size_t offset) { return b_.CreateLoad(out_.pointer(), out_.at(f_->getArg(0), static_cast<std::int64_t>(offset))); };
    arrays_[grouped::Rows] = field(offsetof(packed::CompiledArguments, rows));
    arrays_[grouped::Positions] = field(offsetof(packed::CompiledArguments, q));
    arrays_[grouped::Velocities] = field(offsetof(packed::CompiledArguments, v));
    arrays_[grouped::Coefficients] = field(offsetof(packed::CompiledArguments, coefficients));
    sincos_ = field(offsetof(packed::CompiledArguments, sincos));
    for (Node v = 0; v < line_.entries.size(); ++v)
      for (const grouped::Store& s : line_.stores[v]) places_[v] = Place{false, s.index};
    find_places();
    scratch_ = b_.CreateAlloca(out_.real(8), b_.getInt32(static_cast<unsigned>(scratch_size_ / 8 + 2)));
    scratch_->setAlignment(llvm::Align(64));
    for (Node v = 0; v < line_.entries.size(); ++v) define(v);
    finish();
  }

 private:
  struct Place { bool scratch; std::size_t index; };

  const Entry& e(Node v) const { return line_.entries[v]; }
  llvm::Type* type(std::uint32_t w) { return out_.real(static_cast<int>(w)); }
  bool far(Node user, Node v) const { return e(user).stage - e(v).stage >= far_; }

  /// Where the numbers stand side by side in memory, or all are one number there.
  std::optional<Place> in_memory(const Entry& g) const {
    const auto& first = line_.numbers[g.first];
    if (!places_[first.node]) return std::nullopt;
    const Place p{places_[first.node]->scratch, places_[first.node]->index + first.lane};
    for (std::uint32_t i = g.first; i < g.last; ++i) {
      const Number x = line_.numbers[i];
      if (!places_[x.node] || places_[x.node]->scratch != p.scratch || places_[x.node]->index + x.lane != p.index + (i - g.first)) return std::nullopt;
    }
    return p;
  }
  bool is_broadcast(const Entry& g) const {
    for (std::uint32_t i = g.first; i < g.last; ++i)
      if (line_.numbers[i] != line_.numbers[g.first]) return false;
    return true;
  }
  void need_place(Node v) {
    const Entry& x = e(v);
    if (x.what == Entry::Literal || x.what == Entry::Given || places_[v]) return;
    if (x.what == Entry::Gather) {
      if (is_broadcast(x)) return need_place(line_.numbers[x.first].node);
      if (in_memory(x)) return;
    }
    places_[v] = Place{true, scratch_size_};
    scratch_size_ += x.width;
    scratch_of_[v] = true;
  }
  void find_places() {
    for (Node v = 0; v < line_.entries.size(); ++v) {
      const auto use = [&](Node w) { if (w != grouped::none && far(v, w)) need_place(w); };
      const Entry& x = e(v);
      use(x.a), use(x.b);
      if (x.what == Entry::Sum) for (std::uint32_t i = x.first; i < x.last; ++i) use(line_.terms[i].a), use(line_.terms[i].b);
      if (x.what == Entry::Gather) for (std::uint32_t i = x.first; i < x.last; ++i) use(line_.numbers[i].node);
    }
  }

  Value* address(const Place& p) { return out_.at(p.scratch ? scratch_ : arrays_[grouped::Rows], static_cast<std::int64_t>(8 * p.index)); }
  Value* fetch(Value* at, std::uint32_t w) { return b_.CreateAlignedLoad(type(w), at, llvm::Align(8)); }

  Value* get(Node v) {
    const Entry& x = e(v);
    if (x.what == Entry::Literal) {
      if (values_[v]) return values_[v];
      std::vector<llvm::Constant*> all;
      for (std::uint32_t i = x.first; i < x.last; ++i) all.push_back(llvm::ConstantFP::get(b_.getDoubleTy(), line_.literals[i]));
      return values_[v] = x.width == 1 ? all[0] : llvm::ConstantVector::get(all);
    }
    if (x.what == Entry::Given && x.array == grouped::Coefficients) return fetch(out_.at(arrays_[x.array], static_cast<std::int64_t>(8 * x.index)), x.width);
    if (stage_ - x.stage >= far_) {
      if (places_[v]) return fetch(address(*places_[v]), x.width);
      if (x.what == Entry::Gather) {
        if (is_broadcast(x) && places_[line_.numbers[x.first].node]) {
          const Number n = line_.numbers[x.first];
          Place p = *places_[n.node];
          p.index += n.lane;
          return out_.splat(fetch(address(p), 1), type(x.width));
        }
        if (const auto p = in_memory(x)) return fetch(address(*p), x.width);
      }
    }
    return values_[v];
  }

  Value* number(const Number& n) {
    const Entry& x = e(n.node);
    if (x.what == Entry::Literal) return llvm::ConstantFP::get(b_.getDoubleTy(), line_.literal_of(n));
    if (stage_ - x.stage >= far_ && places_[n.node]) {
      Place p = *places_[n.node];
      p.index += n.lane;
      return fetch(address(p), 1);
    }
    Value* const v = get(n.node);
    return x.width == 1 ? v : b_.CreateExtractElement(v, std::uint64_t{n.lane});
  }

  Value* gathered(const Entry& g) {
    const Number first = line_.numbers[g.first];
    if (g.width == 1) return number(first);
    bool all_far = true;
    std::vector<Node> sources;
    bool shuffles = true;
    for (std::uint32_t i = g.first; i < g.last; ++i) {
      const Number x = line_.numbers[i];
      all_far = all_far && stage_ - e(x.node).stage >= far_ && places_[x.node];
      shuffles = shuffles && e(x.node).width > 1 && e(x.node).what != Entry::Literal;
      if (std::find(sources.begin(), sources.end(), x.node) == sources.end()) sources.push_back(x.node);
    }
    if (all_far) if (const auto p = in_memory(g)) return fetch(address(*p), g.width);
    if (is_broadcast(g) && (all_far || e(first.node).width == 1)) return out_.splat(number(first), type(g.width));
    if (!all_far && shuffles && sources.size() <= 2 && e(sources[0]).width == e(sources.back()).width) {
      std::vector<int> mask;
      for (std::uint32_t i = g.first; i < g.last; ++i) {
        const Number x = line_.numbers[i];
        mask.push_back(static_cast<int>(x.lane + (x.node == sources[0] ? 0 : e(sources[0]).width)));
      }
      Value* const a = get(sources[0]);
      return b_.CreateShuffleVector(a, sources.size() > 1 ? get(sources[1]) : llvm::PoisonValue::get(a->getType()), mask);
    }
    // a base with a few lanes replaced
    Value* out = llvm::PoisonValue::get(type(g.width));
    std::vector<bool> done(g.width, false);
    for (const Node s : sources) {
      if (e(s).width != g.width || e(s).what == Entry::Literal) continue;
      std::uint32_t in_place = 0;
      for (std::uint32_t i = 0; i < g.width; ++i) in_place += line_.numbers[g.first + i] == Number{s, i};
      if (in_place < 2 && g.width > 2) continue;
      if (in_place == 0) continue;
      out = get(s);
      for (std::uint32_t i = 0; i < g.width; ++i) done[i] = line_.numbers[g.first + i] == Number{s, i};
      break;
    }
    for (std::uint32_t i = 0; i < g.width; ++i)
      if (!done[i]) out = b_.CreateInsertElement(out, number(line_.numbers[g.first + i]), std::uint64_t{i});
    return out;
  }

  Value* sum(const Entry& x) {
    Value* out = nullptr;
    for (std::uint32_t i = x.first; i < x.last; ++i) {
      const grouped::Term& t = line_.terms[i];
      Value* a = get(t.a);
      if (t.b == grouped::none) {
        out = !out ? (t.negative ? b_.CreateFNeg(a) : a) : t.negative ? b_.CreateFSub(out, a) : b_.CreateFAdd(a, out);
        continue;
      }
      if (t.negative) a = b_.CreateFNeg(a);
      Value* const y = get(t.b);
      out = out ? out_.fma(a, y, out) : b_.CreateFMul(a, y);
    }
    return out;
  }

  void keep(Node v, Value* x) {
    values_[v] = x;
    for (const grouped::Store& s : line_.stores[v]) b_.CreateAlignedStore(x, out_.at(arrays_[grouped::Rows], static_cast<std::int64_t>(8 * s.index)), llvm::Align(8));
    if (scratch_of_[v]) b_.CreateAlignedStore(x, address(*places_[v]), llvm::Align(8));
  }

  void define(Node v) {
    const Entry& x = e(v);
    stage_ = x.stage;
    switch (x.what) {
      case Entry::Literal: if (!line_.stores[v].empty()) keep(v, get(v)); return;
      case Entry::Given: {
        if (x.array == grouped::Coefficients) return;
        auto* const load = llvm::cast<llvm::LoadInst>(fetch(out_.at(arrays_[x.array], static_cast<std::int64_t>(8 * x.index)), x.width));
        if (x.array != grouped::Rows) load->setVolatile(true);
        values_[v] = load;
        return;
      }
      case Entry::Sum: return keep(v, sum(x));
      case Entry::Quotient: return keep(v, b_.CreateFDiv(get(x.a), get(x.b)));
      case Entry::Root: return keep(v, out_.square_root(get(x.a)));
      case Entry::Magnitude: return keep(v, out_.absolute(get(x.a)));
      case Entry::Gather: return keep(v, gathered(x));
      case Entry::Sines: {
        Value* const a = get(x.a);
        const auto both = sines_in_place(b_, a, [&] { return called(a, x.width); });
        cosines_[v] = both.second;
        return keep(v, both.first);
      }
      case Entry::Cosines: return keep(v, cosines_[x.a]);
    }
  }

  SineAndCosine called(Value* x, std::uint32_t count) {
    llvm::IRBuilder<> entry(&f_->getEntryBlock(), f_->getEntryBlock().begin());
    llvm::AllocaInst* const in = entry.CreateAlloca(type(8));
    llvm::AllocaInst* const out = entry.CreateAlloca(type(8), b_.getInt32(2));
    in->setAlignment(llvm::Align(64)), out->setAlignment(llvm::Align(64));
    b_.CreateAlignedStore(x, in, llvm::Align(8));
    auto* const signature = llvm::FunctionType::get(b_.getVoidTy(), {b_.getPtrTy(), b_.getPtrTy(), b_.getInt32Ty()}, false);
    b_.CreateCall(signature, sincos_, {in, out, b_.getInt32(count)});
    return {fetch(out, count), fetch(out_.at(out, 64), count)};
  }

  void finish() {
    stage_ = line_.stage;
    Value* bad = nullptr;
    const auto add = [&](Value* x) { bad = bad ? b_.CreateOr(bad, x) : x; };
    Value* const check = get(line_.finite);
    Value* const zero = out_.number(0, check->getType());
    Value* const wrong = b_.CreateFCmpUNE(b_.CreateFMul(check, zero), zero);
    add(check->getType()->isVectorTy() ? b_.CreateOrReduce(wrong) : wrong);
    for (const grouped::Check& c : line_.checks) add(b_.CreateFCmpULE(values_[c.value], out_.number(c.least, out_.real(1))));
    b_.CreateRet(b_.CreateSelect(bad, b_.getInt32(2), b_.getInt32(0)));
  }

  Emission& out_;
  llvm::IRBuilder<>& b_;
  const Line& line_;
  llvm::Function* f_ = nullptr;
  Value* arrays_[4] = {};
  Value* sincos_ = nullptr;
  llvm::AllocaInst* scratch_ = nullptr;
  std::size_t scratch_size_ = 0;
  int stage_ = 0, far_ = 2;
  std::vector<Value*> values_;
  std::vector<std::optional<Place>> places_;
  std::vector<bool> scratch_of_;
  std::map<Node, Value*> cosines_;
};

}  // namespace

void emit_trial(Emission& out, const packed::PackedProgram& program, std::size_t stride, int order) {
  const Line line = grouped::Lowering(program, stride, order).run();
  GroupedEmitter(out, line).run();
}

}  // namespace maupertuis::llvm_backend
