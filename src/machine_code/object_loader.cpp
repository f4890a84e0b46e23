#include "machine_code/object_loader.hpp"

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <vector>

#if defined(__linux__) && defined(__x86_64__)
#include <elf.h>
#include <sys/mman.h>
#include <unistd.h>

namespace maupertuis::machine_code {

/// In four passes: sections get their places, are copied, are relocated, and the code is made executable. Every
/// reading of the object is checked against its bounds.
class ObjectLinker {
 public:
  ObjectLinker(std::span<const char> object, Resolver resolve) : object_(object), resolve_(resolve) {}

  std::unique_ptr<LoadedObject> run() {
    read_sections();
    place_sections();
    copy_sections();
    for (const Elf64_Shdr& section : sections_)
      if (section.sh_type == SHT_RELA) relocate(section);
    publish();
    protect();
    return std::move(out_);
  }

 private:
  static constexpr std::size_t stub_size = 16;  // jmp *[rip + 0], then the address
  static constexpr std::size_t absent = ~std::size_t{0};

  [[noreturn]] static void decline(const std::string& what) { throw std::runtime_error(what); }

  const char* bytes(std::size_t at, std::size_t size) const {
    if (at > object_.size() || size > object_.size() - at) decline("the object is cut off");
    return object_.data() + at;
  }
  template <class T>
  std::vector<T> array(std::size_t at, std::size_t count) const {
    if (count > object_.size() / sizeof(T)) decline("the object is cut off");
    std::vector<T> out(count);
    std::memcpy(out.data(), bytes(at, count * sizeof(T)), count * sizeof(T));
    return out;
  }

  void read_sections() {
    const auto header = array<Elf64_Ehdr>(0, 1)[0];
    const bool fits = std::memcmp(header.e_ident, ELFMAG, SELFMAG) == 0 && header.e_ident[EI_CLASS] == ELFCLASS64 &&
                      header.e_type == ET_REL && header.e_machine == EM_X86_64 &&
                      header.e_shentsize == sizeof(Elf64_Shdr);
    if (!fits) decline("the object is not one of this processor");
    sections_ = array<Elf64_Shdr>(header.e_shoff, header.e_shnum);
    for (const Elf64_Shdr& section : sections_)
      if (section.sh_type == SHT_SYMTAB) {
        symbols_ = array<Elf64_Sym>(section.sh_offset, section.sh_size / sizeof(Elf64_Sym));
        names_ = at(sections_, section.sh_link);
      }
  }

  template <class T>
  static const T& at(const std::vector<T>& list, std::size_t index) {
    if (index >= list.size()) decline("the object is damaged");
    return list[index];
  }

  std::string name_of(const Elf64_Sym& symbol) const {
    const char* const all = bytes(names_.sh_offset, names_.sh_size);
    if (symbol.st_name >= names_.sh_size) decline("the object is damaged");
    return {all + symbol.st_name, strnlen(all + symbol.st_name, names_.sh_size - symbol.st_name)};
  }

  /// Code first, then room for the stubs of calls to the outside, then from a new page what is read and written.
  void place_sections() {
    places_.assign(sections_.size(), absent);
    std::size_t end = 0;
    bool writes = false;
    const auto place = [&](bool code) {
      for (std::size_t i = 0; i < sections_.size(); ++i) {
        const Elf64_Shdr& s = sections_[i];
        if (!(s.sh_flags & SHF_ALLOC) || bool(s.sh_flags & SHF_EXECINSTR) != code) continue;
        if (s.sh_size > (std::size_t{1} << 30) || s.sh_addralign > 4096) decline("the object is too large");
        const std::size_t alignment = std::max<std::size_t>(s.sh_addralign, 1);
        places_[i] = end = (end + alignment - 1) / alignment * alignment;
        end += s.sh_size;
        writes = writes || (s.sh_flags & SHF_WRITE);
      }
    };
    place(true);
    stubs_ = end = (end + stub_size - 1) / stub_size * stub_size;
    for (const Elf64_Sym& symbol : symbols_)
      if (symbol.st_shndx == SHN_UNDEF) end += stub_size;
    const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    out_ = std::unique_ptr<LoadedObject>(new LoadedObject);
    out_->code_size_ = end = (end + page - 1) / page * page;
    place(false);
    out_->size_ = std::max<std::size_t>((end + page - 1) / page * page, page);
    writes_ = writes;
  }

  void copy_sections() {
    void* const memory = mmap(nullptr, out_->size_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) decline("no memory for the code");
    out_->memory_ = static_cast<char*>(memory);
    for (std::size_t i = 0; i < sections_.size(); ++i)
      if (places_[i] != absent && sections_[i].sh_type != SHT_NOBITS)
        std::memcpy(out_->memory_ + places_[i], bytes(sections_[i].sh_offset, sections_[i].sh_size),
                    sections_[i].sh_size);
  }

  char* address(std::size_t index) {
    const Elf64_Sym& symbol = at(symbols_, index);
    if (symbol.st_shndx == SHN_UNDEF) return stub(index);
    if (at(places_, symbol.st_shndx) == absent) decline("the object refers to what is not loaded");
    return out_->memory_ + places_[symbol.st_shndx] + symbol.st_value;
  }

  /// Functions outside may be further away than a call reaches.
  char* stub(std::size_t index) {
    const auto [entry, added] = stub_of_.try_emplace(index, out_->memory_ + stubs_ + stub_of_.size() * stub_size);
    if (!added) return entry->second;
    const std::string name = name_of(symbols_[index]);
    void* const target = resolve_(name);
    if (!target) decline("the code calls " + name + ", which is not here");
    static constexpr unsigned char jump[6] = {0xff, 0x25, 0, 0, 0, 0};
    std::memcpy(entry->second, jump, sizeof jump);
    std::memcpy(entry->second + sizeof jump, &target, sizeof target);
    return entry->second;
  }

  void relocate(const Elf64_Shdr& list) {
    const Elf64_Shdr& target = at(sections_, list.sh_info);
    if (places_[list.sh_info] == absent) return;  // of debugging or unwinding
    for (const Elf64_Rela& r : array<Elf64_Rela>(list.sh_offset, list.sh_size / sizeof(Elf64_Rela))) {
      const std::size_t width = ELF64_R_TYPE(r.r_info) == R_X86_64_64 ? 8 : 4;
      if (target.sh_size < width || r.r_offset > target.sh_size - width) decline("the object is damaged");
      char* const place = out_->memory_ + places_[list.sh_info] + r.r_offset;
      const char* const value = address(ELF64_R_SYM(r.r_info)) + r.r_addend;
      apply(ELF64_R_TYPE(r.r_info), place, value);
    }
  }

  static void apply(std::uint32_t type, char* place, const char* value) {
    if (type == R_X86_64_64) {
      std::memcpy(place, &value, 8);
    } else if (type == R_X86_64_PC32 || type == R_X86_64_PLT32) {
      const std::ptrdiff_t distance = value - place;
      const auto near = static_cast<std::int32_t>(distance);
      if (near != distance) decline("the object is too large");
      std::memcpy(place, &near, 4);
    } else {
      decline("the object has a relocation of the unknown kind " + std::to_string(type));
    }
  }

  void publish() {
    for (const Elf64_Sym& symbol : symbols_)
      if (ELF64_ST_BIND(symbol.st_info) == STB_GLOBAL && ELF64_ST_TYPE(symbol.st_info) == STT_FUNC &&
          symbol.st_shndx != SHN_UNDEF && at(places_, symbol.st_shndx) != absent)
        out_->functions_[name_of(symbol)] = out_->memory_ + places_[symbol.st_shndx] + symbol.st_value;
  }

  void protect() {
    char* const memory = out_->memory_;
    const std::size_t code = out_->code_size_, rest = out_->size_ - code;
    const bool done = mprotect(memory, code, PROT_READ | PROT_EXEC) == 0 &&
                      (rest == 0 || writes_ || mprotect(memory + code, rest, PROT_READ) == 0);
    if (!done) decline("this system does not let a program make code executable");
  }

  std::span<const char> object_;
  Resolver resolve_;
  std::vector<Elf64_Shdr> sections_;
  std::vector<Elf64_Sym> symbols_;
  Elf64_Shdr names_{};
  std::vector<std::size_t> places_;  // [sections], from the beginning of the mapping
  std::size_t stubs_ = 0;
  bool writes_ = false;
  std::map<std::size_t, char*> stub_of_;
  std::unique_ptr<LoadedObject> out_;
};

std::unique_ptr<LoadedObject> LoadedObject::load(std::span<const char> object, Resolver resolve, std::string& trouble) {
  try {
    return ObjectLinker(object, resolve).run();
  } catch (const std::runtime_error& error) {
    trouble = error.what();
    return nullptr;
  }
}

LoadedObject::~LoadedObject() {
  if (memory_) munmap(memory_, size_);
}

}  // namespace maupertuis::machine_code

#else  // no ELF, or another processor

namespace maupertuis::machine_code {

std::unique_ptr<LoadedObject> LoadedObject::load(std::span<const char>, Resolver, std::string& trouble) {
  trouble = "compiled kernels need Linux on x86-64";
  return nullptr;
}
LoadedObject::~LoadedObject() = default;

}  // namespace maupertuis::machine_code
#endif

namespace maupertuis::machine_code {

void* LoadedObject::find(std::string_view name) const {
  const auto it = functions_.find(name);
  return it == functions_.end() ? nullptr : it->second;
}

}  // namespace maupertuis::machine_code
