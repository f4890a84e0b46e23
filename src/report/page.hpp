#pragma once
#include <string_view>

namespace maupertuis {

// The files of src/report/page/, compiled in.
extern const std::string_view page_style;
extern const std::string_view page_script;
extern const std::string_view animation_script;

}  // namespace maupertuis
