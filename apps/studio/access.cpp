#include "access.hpp"

#include <sys/random.h>

#include <stdexcept>
#include <vector>

namespace maupertuis::studio {

std::string random_letters(std::size_t bytes) {
  constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
  std::vector<unsigned char> random(bytes);
  for (std::size_t got = 0; got < bytes;) {
    const ssize_t more = getrandom(random.data() + got, bytes - got, 0);
    if (more <= 0) throw std::runtime_error("the system gives no random numbers");
    got += static_cast<std::size_t>(more);
  }
  std::string out;
  for (const unsigned char byte : random) out += letters[byte & 63];
  return out;
}

namespace {

/// In a time that does not depend on where they differ.
bool same(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) difference |= static_cast<unsigned char>(a[i] ^ b[i]);
  return difference == 0;
}

}  // namespace

// Cookies do not tell ports apart: two servers have two names.
std::string Access::cookie_name() const { return "maup-studio-" + std::to_string(port_); }

std::string Access::cookie_header() const {
  return cookie_name() + "=" + cookie_ + "; Path=/; HttpOnly; SameSite=Strict";
}

bool Access::redeem(std::string_view token) {
  const std::lock_guard lock(guard_);
  if (redeemed_ || !same(token, token_)) return false;
  return redeemed_ = true;
}

bool Access::knows(std::string_view cookies) const {
  const std::string name = cookie_name() + "=";
  for (std::size_t at = 0; at < cookies.size();) {
    const std::size_t end = std::min(cookies.find(';', at), cookies.size());
    std::string_view one = cookies.substr(at, end - at);
    while (!one.empty() && one.front() == ' ') one.remove_prefix(1);
    if (one.substr(0, name.size()) == name && same(one.substr(name.size()), cookie_)) return true;
    at = end + 1;
  }
  return false;
}

bool Access::is_host(std::string_view host) const {
  const std::string port = ":" + std::to_string(port_);
  return host == "127.0.0.1" + port || host == "localhost" + port;
}

bool Access::is_origin(std::string_view origin) const {
  constexpr std::string_view scheme = "http://";
  return origin.substr(0, scheme.size()) == scheme && is_host(origin.substr(scheme.size()));
}

}  // namespace maupertuis::studio
