#include "kernel/sparse/loops_code.hpp"

maupertuis::sparse::Loops maupertuis::sparse::baseline_loops() { return loops_of_this_file(); }
