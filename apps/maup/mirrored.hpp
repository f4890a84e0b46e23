#pragma once
#include <maupertuis/modes.hpp>

#include <optional>
#include <vector>

namespace maupertuis::app {

/// An entry whose point and equations are those of an earlier one with some coordinates turned to their opposites: the
/// other well of two, or θ → −θ of polar angles.
struct Mirrored {
  std::size_t of = 0;                 // the earlier entry
  std::vector<std::size_t> turned{};  // coordinates
};
/// The first such entry before `entry`; nothing where there is none, or where the equations have inputs or outputs,
/// which need not mirror.
std::optional<Mirrored> mirrored(const ModalStudy& study, std::size_t entry);

}  // namespace maupertuis::app
