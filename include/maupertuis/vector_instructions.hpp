#pragma once
#include <string>

namespace maupertuis {

/// What the environment variable MAUPERTUIS_INSTRUCTIONS says where that is none of its words, `none`, `avx2` and
/// `avx512`: it is left out of account then. Empty: nothing is wrong with it.
std::string unknown_vector_instructions();

}  // namespace maupertuis
