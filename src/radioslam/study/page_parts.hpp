// The page's text before and after its data; written by cmake/EmbedPage.cmake from study/page.
#pragma once

#include <string_view>

namespace radioslam::study_page {

std::string_view page_head();
std::string_view page_tail();

}  // namespace radioslam::study_page
