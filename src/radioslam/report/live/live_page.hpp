// The page of an agent while it runs, without its state, which comes by /events (live_changes.hpp).
#pragma once

#include <string>

namespace radioslam {

/// `nonce`: of its style and script elements.
std::string live_page_of(const std::string& robot, int dimension, const std::string& nonce);

}  // namespace radioslam
