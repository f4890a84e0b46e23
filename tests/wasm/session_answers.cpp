// session_answers: requests of the studio on standard input, one a line; their answers on standard output. It is what
// the module of WebAssembly is compared with: the same session, compiled for this machine.
#include <maupertuis/studio.hpp>

#include <iostream>
#include <string>

int main() {
  maupertuis::studio::Session session;
  for (std::string request; std::getline(std::cin, request);)
    std::cout << session.answer(request) << '\n' << std::flush;
}
