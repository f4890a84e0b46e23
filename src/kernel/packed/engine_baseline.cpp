#define MAUP_ENGINE baseline
#define MAUP_ENGINE_NAME "generic"
#include "kernel/packed/engine_code.hpp"
