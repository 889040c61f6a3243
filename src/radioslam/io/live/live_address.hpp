// Where a program's live page is: PORT of this machine alone, or ADDRESS:PORT.
#pragma once

#include <string>

namespace radioslam {

struct LiveAddress {
  std::string host = "127.0.0.1";  ///< a name or an address, without brackets
  int port = 0;                    ///< 0: any that is free

  bool operator==(const LiveAddress&) const = default;
};

/// "8080", "0.0.0.0:8080", "[::1]:8080". Refuses (InputError) anything else.
LiveAddress parse_live_address(const std::string& text);

/// Whether a host is reached from this machine alone: localhost, ::1 or 127.x.x.x.
bool is_loopback(const std::string& host);

std::string to_string(const LiveAddress& address);

/// http://127.0.0.1:8080/, with the token if there is one.
std::string url_of(const LiveAddress& address, const std::string& token);

/// Refuses (InputError) an address that this machine does not have, and a port that another program has or
/// that this one may not have.
void refuse_unusable(const LiveAddress& address);

/// 128 bits from the system's source, as text.
std::string drawn_token();

/// The token that the page asks for: the given one, of letters, digits and ._~- (else InputError); without
/// one, none on this machine alone, and a drawn one elsewhere.
std::string token_of(const LiveAddress& address, const std::string& given);

}  // namespace radioslam
