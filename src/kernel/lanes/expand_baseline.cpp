// Compiled for what every processor of the kind has.
#include "kernel/lanes/expand.hpp"

maupertuis::lanes::Expanders maupertuis::lanes::baseline_expanders() { return expanders_of_this_file(); }
