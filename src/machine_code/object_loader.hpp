#pragma once
#include <cstddef>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace maupertuis::machine_code {

/// The address of a function that code calls, by name; null if there is none.
using Resolver = void* (*)(const std::string& name);

/// A relocatable ELF object made callable: one mapping, code executable, nothing both writable and executable. Holds
/// what the emitters of machine_code/llvm make, position-independent code of x86-64, and declines the rest. Faster than
/// a linker of LLVM's, and there without LLVM: what stands in the cache runs in well under a millisecond.
class LoadedObject {
 public:
  /// Nothing, with the reason in `trouble`, if the object is damaged, needs what is not known, or memory is refused.
  static std::unique_ptr<LoadedObject> load(std::span<const char> object, Resolver resolve, std::string& trouble);
  ~LoadedObject();
  LoadedObject(const LoadedObject&) = delete;
  LoadedObject& operator=(const LoadedObject&) = delete;

  /// A global function; null if there is none of this name.
  void* find(std::string_view name) const;
  std::size_t code_size() const { return code_size_; }

 private:
  friend class ObjectLinker;
  LoadedObject() = default;
  char* memory_ = nullptr;
  std::size_t size_ = 0, code_size_ = 0;
  std::map<std::string, void*, std::less<>> functions_;
};

}  // namespace maupertuis::machine_code
