// A DDS type whose samples are bytes in CDR, handed on as they are: no generated code, and what is read from
// the wire is read as from a recording. The type has a name and no key.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

struct ddsi_serdata;
struct ddsi_sertype;

namespace radioslam {

/// The caller owns it until a topic has been made of it.
ddsi_sertype* make_raw_type(const std::string& name);

/// A sample to be written, which then belongs to Cyclone. `cdr` begins with its four bytes of encapsulation.
ddsi_serdata* make_raw_sample(const ddsi_sertype* type, std::string_view cdr);

/// The bytes of a sample of such a type, with up to three bytes of padding behind them if it came over the
/// wire.
std::string_view raw_bytes(const ddsi_serdata* sample);

}  // namespace radioslam
