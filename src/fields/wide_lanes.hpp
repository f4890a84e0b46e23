#pragma once
#include <cstddef>

/// Loops over lanes are compiled for several instruction sets, and the processor's is taken when the program starts.
/// Without contraction the numbers are the same in all of them.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define MAUP_LANES __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default"), optimize("O3")))
#else
#define MAUP_LANES
#endif

namespace maupertuis {

/// Eight lanes: what the compiler makes of them is the processor's.
typedef double Lanes __attribute__((vector_size(64), aligned(8), may_alias));
constexpr std::size_t kWide = 8;

inline const Lanes& lanes_at(const double* place) { return *reinterpret_cast<const Lanes*>(place); }
inline Lanes& lanes_at(double* place) { return *reinterpret_cast<Lanes*>(place); }

}  // namespace maupertuis
