#include "server/picture/plot_buffer.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

namespace kinescope::app {

PlotBuffer::PlotBuffer(std::vector<int> joints) : joints_(std::move(joints)) {
  for (const int joint : joints_) {
    curves_.push_back({std::string(urdf::kJoints[urdf::At(joint)].label), {}});
  }
}

void PlotBuffer::Add(const SceneState& state, double secs) {
  const auto person = std::find_if(state.people.begin(), state.people.end(),
                                   [](const PersonState& p) { return !p.loads.empty(); });
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    render::LoadPoint point{secs, std::numeric_limits<double>::quiet_NaN(), LoadClass::kUnknown};
    if (person != state.people.end()) {
      for (const JointLoad& load : person->loads) {
        if (load.joint != joints_[i]) continue;
        point.ratio = load.shown_ratio;
        point.load_class = load.load_class;
      }
    }
    curves_[i].points.push_back(point);
  }
  last_secs_ = secs;
}

render::LoadCurves PlotBuffer::All() const {
  // One scene alone has no duration; any will do.
  return {0, std::max(last_secs_, 0.1), curves_};
}

render::LoadCurves PlotBuffer::Last(double length_secs) {
  constexpr double kRounding = 1e-6;  // s
  const double from = last_secs_ - length_secs;
  for (render::LoadCurve& curve : curves_) {
    const auto first = std::find_if(
        curve.points.begin(), curve.points.end(),
        [&](const render::LoadPoint& point) { return point.secs >= from - kRounding; });
    curve.points.erase(curve.points.begin(), first);
  }
  return {std::max(from, 0.0), std::max(last_secs_, std::max(from, 0.0) + length_secs), curves_};
}

}  // namespace kinescope::app
