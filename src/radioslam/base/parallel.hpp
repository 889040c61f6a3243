// Loops over independent items on several threads, with results that do not depend on how many.
#pragma once

#include <cstddef>
#include <functional>

namespace radioslam {

/// How many threads parallel_for may use; 0 restores the default (every core). Set once, by the program.
void set_thread_count(std::size_t threads);
std::size_t thread_count();

/// Calls body(begin, end) over disjoint ranges that cover [0, count), each at least `grain` long.
/// The body must write only to places that belong to its items: then the result is the same for any
/// number of threads. An exception in a body is rethrown here.
void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t begin, std::size_t end)>& body);

}  // namespace radioslam
