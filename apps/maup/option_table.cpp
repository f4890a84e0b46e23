#include "option_table_of.hpp"

#include <CLI/CLI.hpp>

namespace maupertuis::app {
namespace {

/// "{auto,taylor,stiff}", which the parser says of a choice, behind the name of the value: METHOD:{auto,taylor,stiff}.
std::vector<std::string> words_of(const std::string& value) {
  const auto begin = value.find(":{"), end = value.rfind('}');
  if (begin == std::string::npos || end == std::string::npos) return {};
  return CLI::detail::split(value.substr(begin + 2, end - begin - 2), ',');
}

OptionRow row_of(const CLI::Option& option) {
  OptionRow row;
  row.positional = option.get_positional();
  if (row.positional) row.names = {option.get_name(true, false)};
  for (const std::string& name : option.get_snames()) row.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) row.names.push_back("--" + name);
  if (option.get_items_expected_max() > 0) {
    const std::string value = option.get_type_name();
    row.value = value.substr(0, value.find(':'));
    row.words = words_of(value);
    row.value_optional = option.get_items_expected_min() == 0 && !row.positional;
    row.many = option.get_items_expected_max() > 1;
  }
  row.what = option.get_description();
  row.required = option.get_required();
  return row;
}

std::vector<OptionRow> rows_of(const CLI::App& app) {
  std::vector<OptionRow> rows;
  for (const CLI::Option* option : app.get_options()) rows.push_back(row_of(*option));
  return rows;
}

}  // namespace

void fill_option_table(const CLI::App& app, OptionTable& table) {
  table.program = app.get_name();
  table.summary = app.get_description();
  table.options = rows_of(app);
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    CommandRow row;
    row.name = command->get_name();
    row.summary = command->get_description();
    row.later = command->get_group() != "Subcommands";
    row.options = rows_of(*command);
    table.commands.push_back(std::move(row));
  }
}

}  // namespace maupertuis::app
