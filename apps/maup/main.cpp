#include "command_line.hpp"

int main(int argc, char** argv) { return maupertuis::app::run(argc, argv); }
