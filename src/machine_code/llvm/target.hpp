#pragma once
#include <memory>
#include <string>
#include <vector>

namespace llvm {
class Module;
class TargetMachine;
}  // namespace llvm

namespace maupertuis::llvm_backend {

/// What code may use of the processor.
struct Features {
  bool fma = false;
  int vector_width = 2;  // doubles of the widest register: 2, 4, 8
  bool avx = false;
};

/// Of LLVM, for one processor.
class Target {
 public:
  /// "": this one; else by LLVM's name. Throws Declined for an unknown one.
  explicit Target(const std::string& processor);
  ~Target();

  const Features& features() const { return features_; }
  llvm::TargetMachine& machine() const { return *machine_; }
  /// The module as a relocatable object. `effort`: of the request.
  std::vector<char> compile(llvm::Module& module, unsigned effort);

 private:
  std::unique_ptr<llvm::TargetMachine> machine_;
  Features features_;
};

/// The name that LLVM gives to this processor.
const std::string& host_processor();

}  // namespace maupertuis::llvm_backend
