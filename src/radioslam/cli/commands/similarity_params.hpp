// Parameters of `radioslam similarity`, with the same names as in `radioslam run`.
#pragma once

#include "radioslam/radio/fingerprints/fingerprint.hpp"
#include "radioslam/radio/fingerprints/similarity.hpp"

namespace radioslam::cli {

struct SimilarityRadioParams {
  FingerprintParams fingerprint;
  SimilarityParams similarity;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    FingerprintParams::visit_fields(self.fingerprint, visit);
    SimilarityParams::visit_fields(self.similarity, visit);
  }
};

struct SimilarityCommandParams {
  SimilarityRadioParams radio;

  template <class Self, class Visitor>
  static void visit_sections(Self& self, Visitor&& visit) {
    visit("radio", self.radio);
  }
};

}  // namespace radioslam::cli
