#include "radioslam/eval/access_point_errors.hpp"

#include <algorithm>

#include "radioslam/mission/known_access_points.hpp"

namespace radioslam {

AccessPointErrors access_point_errors(const std::vector<LocatedAccessPoint>& located, const Mission& mission,
                                      const SE3& T_truth_estimate) {
  AccessPointErrors result;
  std::vector<double> errors_m;
  for (const KnownAccessPoint& known : known_access_points(mission)) {
    ++result.known;
    const std::string& bssid = mission.access_points[known.access_point.index()];
    const auto found = std::find_if(located.begin(), located.end(), [&](const LocatedAccessPoint& of) {
      return of.is_found && of.bssid == bssid;
    });
    if (found == located.end()) continue;
    const Eigen::Vector3d place(found->position_m.x(), found->position_m.y(), 0);
    errors_m.push_back(((T_truth_estimate * place).head<2>() - known.position_m).norm());
  }
  result.located = errors_m.size();
  result.errors = summarise_errors(std::move(errors_m));
  return result;
}

}  // namespace radioslam
