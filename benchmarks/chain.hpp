#pragma once
#include <maupertuis/equations_of_motion.hpp>

#include <memory>
#include <string>

namespace bench {

/// A chain of n pendulums, each point defined from the one before, as `maup new chain` writes it.
std::string chain_text(int links);

/// Reads a model that is known to be right; throws otherwise.
std::shared_ptr<const maupertuis::Model> read(const std::string& text);
maupertuis::EquationsOfMotion derive(const std::shared_ptr<const maupertuis::Model>& model);

}  // namespace bench
