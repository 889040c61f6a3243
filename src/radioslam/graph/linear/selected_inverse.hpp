// Selected inverse: entries of the inverse on the factor's pattern, computed front by front from the root
// down. Source: Erisman and Tinney 1975; on fronts as in Lin et al. 2011 (SelInv).
#pragma once

#include "radioslam/graph/linear/front_tree.hpp"
#include "radioslam/graph/linear/number_store.hpp"

namespace radioslam {

struct SelectedInverse::Impl {
  std::shared_ptr<const FrontTree> tree;
  NumberStore panels;  ///< stored like the factor's: covariances of the pivots with all rows
};

/// `stack` holds tree->covariance_scalars numbers, whose contents are lost.
std::shared_ptr<const SelectedInverse::Impl> invert(std::shared_ptr<const FrontTree> tree,
                                                    const NumberStore& factor, NumberStore& stack);

}  // namespace radioslam
