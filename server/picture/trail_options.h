/// The options of trails, of the commands that draw them: --trail and --trail_secs.
#pragma once

#include "server/options/option_list.h"
#include "server/picture/trails.h"

namespace kinescope::app {

struct TrailOptions {
  TrailOptions();

  options::List<int> points;  // urdf::Segment; -1: the centre of mass
  options::Number secs;

  TrailSettings Settings() const { return {*points, *secs}; }

  /// They are borrowed.
  void List(options::OptionList& option);
};

}  // namespace kinescope::app
