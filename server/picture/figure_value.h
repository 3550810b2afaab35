/// The option --figure of the commands that draw people.
#pragma once

#include "render/scene_look.h"
#include "server/options/option_list.h"

namespace kinescope::app {

struct FigureValue : options::Choice<render::Figure> {
  FigureValue()
      : Choice({{"skin", render::Figure::kSkin}, {"urdf", render::Figure::kUrdf}},
               render::SceneLook().figure) {}
};

inline constexpr char kFigureHelp[] =
    "people as one skin, or as the rigid parts of the URDF that RViz shows";

}  // namespace kinescope::app
