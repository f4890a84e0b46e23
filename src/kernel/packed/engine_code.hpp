// No include guard: each engine_*.cpp compiles this once, for its own instruction set, in a namespace of its own.
#include <maupertuis/rough_powers.hpp>
#include "kernel/packed/engine.hpp"
#include "kernel/series/sine_cosine.hpp"

#include "kernel/packed/engine_vectors.hpp"

#include "kernel/packed/engine_convolution.hpp"

#include "kernel/packed/engine_stage.hpp"

#include "kernel/packed/engine_tangents.hpp"

#include "kernel/packed/engine_solution.hpp"

#include "kernel/packed/engine_polynomials.hpp"

namespace maupertuis::packed::MAUP_ENGINE {

extern const Engine engine;
const Engine engine{MAUP_ENGINE_NAME,
                    run_stage,
                    renew_blocks,
                    tangents,
                    negative_inverse,
                    transpose,
                    solve_by_inverse,
                    rows_are_finite,
                    add,
                    cancel,
                    negate,
                    set_accelerations,
                    correct,
                    run_stages_by_inverse,
                    increments,
                    accelerations,
                    sizes,
                    add_increments,
                    radius};

}  // namespace maupertuis::packed::MAUP_ENGINE
