#pragma once
#include "option_table.hpp"

namespace CLI {
class App;
}

namespace maupertuis::app {

/// All but the version and the examples, from the parser's own tables.
void fill_option_table(const CLI::App& app, OptionTable& table);

}  // namespace maupertuis::app
