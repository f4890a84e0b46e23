#include "kernel/dynamics/evaluate_code.hpp"

maupertuis::dynamics::Evaluate maupertuis::dynamics::baseline_evaluate() { return evaluate; }
