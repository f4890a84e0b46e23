#define MAUP_ENGINE avx2
#define MAUP_ENGINE_NAME "AVX2"
#include "kernel/packed/engine_code.hpp"
