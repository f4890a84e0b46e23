#define MAUP_ENGINE avx512
#define MAUP_ENGINE_NAME "AVX-512"
#include "kernel/packed/engine_code.hpp"
