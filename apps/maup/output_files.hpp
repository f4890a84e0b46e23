#pragma once
#include <maupertuis/diagnostic.hpp>

#include <initializer_list>
#include <string>

namespace maupertuis::app {

/// What a file that is asked for will hold; its endings say so.
enum class FileKind {
  Picture,
  Table,
  Csv,
  Page,
  Model,
  Animation
};  // .svg, .png, .pdf; .csv, .npy, .json; .csv; .html, .htm; .lag; .mp4, …

struct OutputFile {
  const char* option;  // that asks for it, as it is written
  std::string path;    // empty: it is not asked for
  FileKind kind;
};

/// Before anything is computed: E0810 for an ending of another kind, E0812 for the model that is read and for a link to
/// another one, E0804 for a folder that is missing, E0809 where two options ask for one file. Model "-": the file
/// behind standard input. Devices and pipes take what they are given, tables apart: their format is in the name. "-" is
/// a file name here; commands that take it for standard output leave it out.
void check_output_files(std::initializer_list<OutputFile> files, const std::string& model, Diagnostics& diagnostics);
/// A model that is written takes the place of no file unless `force`d to: E0807. Devices and pipes take it.
void check_is_new(const std::string& path, bool force, Diagnostics& diagnostics);

}  // namespace maupertuis::app
