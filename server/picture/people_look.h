/// How people are drawn: the options --figure, --style and --loads of the commands that draw them.
#pragma once

#include <string>

#include "render/scene_look.h"
#include "server/options/option_list.h"
#include "server/picture/figure_value.h"

namespace kinescope::app {

struct StyleValue : options::Choice<render::Style> {
  StyleValue();
  using Choice::operator=;
};

struct LoadsShownValue : options::Choice<render::LoadsShown> {
  LoadsShownValue();
  using Choice::operator=;
};

/// Lists all three. They are borrowed.
void ListPeopleLook(options::OptionList& option, FigureValue& figure, StyleValue& style,
                    LoadsShownValue& loads);

/// Their values.
struct PeopleLook {
  render::Figure figure = render::SceneLook().figure;
  render::Style style = render::SceneLook().style;
  render::LoadsShown loads = render::SceneLook().loads;

  void ApplyTo(render::SceneLook& look) const;
};

/// @throws UsageError as FigureValue::Load.
PeopleLook LoadPeopleLook(const FigureValue& figure, const StyleValue& style,
                          const LoadsShownValue& loads);

}  // namespace kinescope::app
