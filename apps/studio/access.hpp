#pragma once
#include <mutex>
#include <string>
#include <string_view>

namespace maupertuis::studio {

/// So many random bytes from the system, in letters that stand in addresses.
std::string random_letters(std::size_t bytes);

/// Who may ask. The address that the program prints holds a token, which is good once: whoever brings it gets a cookie,
/// and all further requests need that. Pages of other sites in the same browser can neither read the cookie nor send it
/// (HttpOnly, SameSite=Strict), and a name that was made to point to 127.0.0.1 is not our Host. Browsers do send it to
/// other ports of 127.0.0.1: who has an account on this machine, and is visited there by the browser, can read it.
class Access {
 public:
  explicit Access(int port) : port_(port), token_(random_letters(24)), cookie_(random_letters(24)) {}

  const std::string& token() const { return token_; }
  std::string cookie_header() const;
  std::string cookie_name() const;

  /// Takes the token; false where it is another, or was taken.
  bool redeem(std::string_view token);
  bool knows(std::string_view cookies) const;
  /// 127.0.0.1:PORT or localhost:PORT.
  bool is_host(std::string_view host) const;
  /// http:// and a host of ours.
  bool is_origin(std::string_view origin) const;

 private:
  int port_;
  std::string token_, cookie_;
  bool redeemed_ = false;
  std::mutex guard_;
};

}  // namespace maupertuis::studio
