#include "kernel/straight_line/evaluate_code.hpp"

maupertuis::straight::Evaluate maupertuis::straight::baseline_evaluate() { return evaluate; }
