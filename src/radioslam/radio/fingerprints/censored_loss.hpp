// Loss of a censored reading: all that is known of it is that it was below a threshold, z standard deviations
// above its prediction.
//
//   cost(z) = -2 log Phi(z),   hazard(z) = phi(z) / Phi(z) = -cost'(z) / 2,   hazard'(z) = -hazard (hazard +
//   z)
//
// (Tobin 1958). Both are interpolated between tabulated values by cubic Hermite polynomials (errors below
// 1e-7), as a fit evaluates them some 100,000 times per access point; far below the threshold they are
// continued by a parabola and its slope, far above it they are zero.
#pragma once

namespace radioslam {

struct CensoredLoss {
  double cost = 0;
  double hazard = 0;
};

CensoredLoss censored_loss(double z);

}  // namespace radioslam
