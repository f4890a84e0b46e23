#include "command_line.hpp"

int main(int argc, char** argv) { return maup::run(argc, argv); }
