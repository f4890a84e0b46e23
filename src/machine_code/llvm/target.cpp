#include "machine_code/llvm/target.hpp"

#include "machine_code/llvm/emitters.hpp"

#include <llvm/ADT/SmallVector.h>
#include <llvm/IR/LegacyPassManager.h>
#include <llvm/IR/Module.h>
#include <llvm/MC/MCSubtargetInfo.h>
#include <llvm/MC/TargetRegistry.h>
#include <llvm/Pass.h>
#include <llvm/Support/CommandLine.h>
#include <llvm/Support/raw_ostream.h>
#include <llvm/Support/TargetSelect.h>
#include <llvm/Target/TargetMachine.h>
#include <llvm/TargetParser/Host.h>
#include <llvm/Transforms/Scalar.h>

namespace maupertuis::llvm_backend {
namespace {

constexpr unsigned quick_effort = 2;
constexpr char triple[] = "x86_64-pc-linux-gnu";

/// Loops are emitted with the addresses that they are to have, two that move and constants beside them; strength
/// reduction would give every operand an address of its own and keep them on the stack.
void leave_loops_alone() {
  const char* const options[] = {"maupertuis", "-disable-lsr"};
  llvm::cl::ParseCommandLineOptions(2, options);
}

const llvm::Target& x86() {
  static const llvm::Target* const target = [] {
    leave_loops_alone();
    LLVMInitializeX86TargetInfo();
    LLVMInitializeX86Target();
    LLVMInitializeX86TargetMC();
    LLVMInitializeX86AsmPrinter();
    std::string error;
    return llvm::TargetRegistry::lookupTarget(triple, error);
  }();
  if (!target) throw Declined("this LLVM has no code for x86-64");
  return *target;
}

std::string host_features() {
  std::string out;
  for (const auto& [name, has] : llvm::sys::getHostCPUFeatures()) {
    if (!out.empty()) out += ',';
    out += (has ? "+" : "-") + name.str();
  }
  return out;
}

std::unique_ptr<llvm::TargetMachine> machine_for(const std::string& processor, const std::string& features) {
  std::unique_ptr<llvm::TargetMachine> out(x86().createTargetMachine(
      triple, processor, features, {}, llvm::Reloc::PIC_, llvm::CodeModel::Small, llvm::CodeGenOptLevel::Default));
  if (!out) throw Declined("LLVM makes no code for " + processor);
  return out;
}

void require_known(const std::string& processor) {
  if (!machine_for("x86-64", "")->getMCSubtargetInfo()->isCPUStringValid(processor))
    throw Declined("LLVM knows no processor named " + processor);
}

}  // namespace

const std::string& host_processor() {
  static const std::string name = llvm::sys::getHostCPUName().str();
  return name;
}

Target::Target(const std::string& processor) {
  if (!processor.empty()) require_known(processor);
  machine_ = processor.empty() ? machine_for(host_processor(), host_features()) : machine_for(processor, "");
  const auto has = [this](const char* feature) { return machine_->getMCSubtargetInfo()->checkFeatures(feature); };
  features_.avx = has("+avx");
  features_.fma = has("+fma") && has("+avx2");
  const bool widest = features_.fma && has("+avx512f") && has("+avx512dq") && has("+avx512vl");
  features_.vector_width = widest ? 8 : features_.avx ? 4 : 2;
}

Target::~Target() = default;

/// No level reorders sums or products or contracts them, so that all give the same numbers. `Less` writes code as fast
/// as `Default` does for what is emitted here, in two thirds of the time.
std::vector<char> Target::compile(llvm::Module& module, unsigned effort) {
  machine_->setOptLevel(effort == quick_effort ? llvm::CodeGenOptLevel::None : llvm::CodeGenOptLevel::Less);
  if (features_.vector_width == 8)
    for (llvm::Function& f : module) {
      // LLVM takes narrower registers of its own accord on some of these processors.
      f.addFnAttr("prefer-vector-width", "512");
      f.addFnAttr("min-legal-vector-width", "512");
    }
  llvm::SmallVector<char, 0> bytes;
  llvm::raw_svector_ostream stream(bytes);
  llvm::legacy::PassManager passes;
  passes.add(llvm::createEarlyCSEPass());
  const bool cannot = machine_->addPassesToEmitFile(passes, stream, nullptr, llvm::CodeGenFileType::ObjectFile, true);
  if (cannot) throw Declined("LLVM writes no objects here");
  passes.run(module);
  return {bytes.begin(), bytes.end()};
}

}  // namespace maupertuis::llvm_backend
