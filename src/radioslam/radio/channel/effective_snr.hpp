// Effective SNR: SNR of a flat channel that has the mean bit error rate of a frequency-selective one.
//   ESNR = BER^-1( mean over subcarriers of BER(SNR_k) )
//   BER(rho): BPSK Q(sqrt(2 rho));  QPSK Q(sqrt(rho));
//             16-QAM 3/4 Q(sqrt(rho / 5));  64-QAM 7/12 Q(sqrt(rho / 21))
// Source: Halperin et al. 2010, "Predictable 802.11 packet delivery from wireless channel measurements".
// Error rates are handled as logarithms: at 80 dB they are exp(-1e8). The more bits per symbol, the smaller
// the effect of one weak subcarrier: min SNR <= ESNR of BPSK <= QPSK <= 16-QAM <= 64-QAM <= mean SNR
// (linear), like certainty equivalents of utilities with decreasing risk aversion a / 2 + 1 / (2 rho) (Pratt
// 1964). SNRs are in dB; -infinity is allowed and means a subcarrier without signal.
#pragma once

#include <span>
#include <vector>

namespace radioslam {

enum class Modulation { kBpsk, kQpsk, kQam16, kQam64 };

/// log BER(snr), accurate for any SNR, also where the rate itself underflows a double.
double log_bit_error_rate(double snr_db, Modulation modulation);

/// Takes at least one SNR, none NaN or +infinity; returns -infinity where no subcarrier has a signal. Cost:
/// one error function per subcarrier and 60 more.
double effective_snr_db(std::span<const double> snr_db, Modulation modulation);

}  // namespace radioslam
