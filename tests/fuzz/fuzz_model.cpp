// Any text: parse → format → check → derive → certify. A mistake in it is a diagnostic; an exception, a failed
// requirement, a sanitizer's report or a hang is a defect.
#include <maupertuis/certificate.hpp>

#include <cstdint>
#include <cstdlib>

using namespace maupertuis;

namespace {

/// Formatting must not change what a text means to the parser, and must settle at once.
void check_format(const syntax::SyntaxTree& tree, const SourceText& source) {
  const std::string once = syntax::format(tree, source);
  const SourceText again("fuzz", once);
  Diagnostics diagnostics;
  const syntax::SyntaxTree second = syntax::parse(again, diagnostics);
  if (diagnostics.has_errors() || syntax::format(second, again) != once) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const SourceText source("fuzz", std::string(reinterpret_cast<const char*>(data), size));
  Diagnostics diagnostics;
  const syntax::SyntaxTree tree = syntax::parse(source, diagnostics);
  if (diagnostics.has_errors()) {
    render(diagnostics, source);
    return 0;
  }
  check_format(tree, source);
  auto read = elaborate(tree, source, diagnostics);
  if (!read) return render(diagnostics, source), 0;
  lint(*read, source, diagnostics);
  if (diagnostics.has_errors()) return render(diagnostics, source), 0;
  const auto model = std::make_shared<const Model>(std::move(*read));
  const auto equations = euler_lagrange({model, &model->system}, diagnostics);
  if (!equations) return 0;
  const Derivation derivation = readable_derivation(*equations, false);
  for (const CertificateCheck& check : certify(*equations, &derivation).checks)
    if (check.applies && check.verdict == Verdict::Nonzero) std::abort();
  return 0;
}
