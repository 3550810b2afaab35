/// How people are drawn: the options --figure, --style, --loads and --body_opacity of the commands
/// that draw them.
#pragma once

#include <string>

#include "render/scene_look.h"
#include "server/options/option_list.h"
#include "server/options/value.h"
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

/// 1 unless told, from 0 to 1.
options::Number BodyOpacity();

/// Lists all of them. They are borrowed.
void ListPeopleLook(options::OptionList& option, FigureValue& figure, StyleValue& style,
                    LoadsShownValue& loads, options::Number& body_opacity);

/// Their values.
struct PeopleLook {
  render::Figure figure = render::SceneLook().figure;
  render::Style style = render::SceneLook().style;
  render::LoadsShown loads = render::SceneLook().loads;
  double body_opacity = 1;

  void ApplyTo(render::SceneLook& look) const;
};

/// @throws UsageError as FigureValue::Load.
PeopleLook LoadPeopleLook(const FigureValue& figure, const StyleValue& style,
                          const LoadsShownValue& loads, const options::Number& body_opacity);

}  // namespace kinescope::app
