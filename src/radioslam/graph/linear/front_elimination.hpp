// Elimination of a front's pivots on several threads: the kernels' steps, with the rows of each divided among
// the threads. Every entry is the same chain of operations as in the kernel that does all at once
// (dense_product.hpp), so the bytes are its, for any number of threads.
#pragma once

#include "radioslam/graph/linear/front_kernels.hpp"

namespace radioslam {

/// FrontKernels::eliminate. Small fronts, which would not repay the threads, are left to one.
bool eliminate_front(const FrontKernels& kernels, FrontShape shape, double* panel, double* update);
/// The same in steps, whatever the size.
bool eliminate_front_in_steps(const FrontKernels& kernels, FrontShape shape, double* panel, double* update);

}  // namespace radioslam
