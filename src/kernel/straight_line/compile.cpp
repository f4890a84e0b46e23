#include "kernel/straight_line/compile.hpp"

#include "kernel/program/code.hpp"

#include <string>

namespace maupertuis::straight {
namespace {

void add(machine_code::Digester& d, const Node& node) {
  for (const std::uint64_t part :
       {std::uint64_t(node.what), std::uint64_t(node.wide), std::uint64_t(node.width), std::uint64_t(node.function),
        std::uint64_t(node.a), std::uint64_t(node.b), std::uint64_t(node.c), std::uint64_t(node.array),
        std::uint64_t(node.index), std::uint64_t(node.first), std::uint64_t(node.last)})
    d.add(part);
  d.add_double(node.literal);
}

void add(machine_code::Digester& d, const StraightLine& line) {
  for (const std::size_t part :
       {line.nodes.size(), line.terms.size(), line.operands.size(), line.stores.size(), line.checks.size(),
        line.finite.size(), std::size_t{line.arrays}, std::size_t{line.wide}, std::size_t{line.guarded}})
    d.add(part);
  for (const Node& node : line.nodes) add(d, node);
  for (const Term& term : line.terms) d.add_double(term.factor), d.add(term.a), d.add(term.b), d.add(term.c);
  for (const Value v : line.operands) d.add(v);
  for (const Store& store : line.stores) d.add(store.value), d.add(store.array), d.add(store.index);
  for (const PivotCheck& check : line.checks) d.add(check.pivot), d.add(check.size), d.add_double(check.share);
  for (const Value v : line.finite) d.add(v);
}

}  // namespace

std::pair<Code, CompileReport> compile(const std::vector<StraightLine>& lines, const CompileOptions& options) {
  machine_code::Digester digester;
  digester.add(lines.size());
  for (const StraightLine& line : lines) add(digester, line);
  machine_code::Request request;
  request.emitter = machine_code::Emitter::StraightLines;
  request.source = &lines;
  const machine_code::Compiled made = machine_code::compile(request, digester.digest(), options);
  Code code;
  code.memory_ = made.code;
  for (std::size_t i = 0; made.code && i < lines.size(); ++i)
    code.functions_.push_back(made.code->find("line" + std::to_string(i)));
  return {std::move(code), report_of(made)};
}

}  // namespace maupertuis::straight
