// The report's page before and after its data; written by cmake/EmbedPage.cmake from report/page.
#pragma once

#include <string_view>

namespace radioslam {

std::string_view page_head();
std::string_view page_tail();

}  // namespace radioslam
