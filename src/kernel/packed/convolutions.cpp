#include "kernel/packed/convolutions.hpp"

namespace maupertuis::packed {

std::vector<Convolution> convolutions_of(const PackedProgram& program, const Pack& pack) {
  std::vector<Convolution> out;
  switch (pack.kind) {
    case Pack::Sum:
      for (std::uint32_t i = pack.first_product; i < pack.last_product; ++i)
        out.push_back({program.products[i].a, program.products[i].b, pack.lag});
      break;
    case Pack::Integral: out.push_back({pack.a, pack.b, pack.lag}); break;
    case Pack::Quotient: out.push_back({pack.b, pack.y, pack.lag}); break;
    case Pack::SquareRoot: out.push_back({pack.y, pack.y, pack.lag}); break;
    case Pack::Scan:
    case Pack::ScanDown:
    case Pack::Strand:
    case Pack::Join:
    case Pack::JoinDown:
    case Pack::Scalar:
      break;
  }
  return out;
}

std::size_t count_convolutions(const PackedProgram& program) {
  std::size_t count = 0;
  for (const Pack& pack : program.packs) count += convolutions_of(program, pack).size();
  return count;
}

}  // namespace maupertuis::packed
