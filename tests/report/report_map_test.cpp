// Maps of the team on the page.
#include <gtest/gtest.h>

#include "report/sample_page.hpp"
