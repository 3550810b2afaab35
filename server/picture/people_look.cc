#include "server/picture/people_look.h"

namespace kinescope::app {

StyleValue::StyleValue()
    : Choice({{"matte", render::Style::kMatte},
              {"clay", render::Style::kClay},
              {"line", render::Style::kLine}},
             render::SceneLook().style) {}

LoadsShownValue::LoadsShownValue()
    : Choice({{"spheres", render::LoadsShown::kSpheres},
              {"skin", render::LoadsShown::kSkin},
              {"both", render::LoadsShown::kBoth}},
             render::SceneLook().loads) {}

options::Number BodyOpacity() { return {1, {0, 1}}; }

void ListPeopleLook(options::OptionList& option, FigureValue& figure, StyleValue& style,
                    LoadsShownValue& loads, options::Number& body_opacity) {
  option("figure", figure, kFigureHelp);
  option("style", style, "how bodies are drawn: in a suit, in one colour, or as lines");
  option("loads", loads,
         "where the classes of joint loads are shown: as spheres, as regions of the skin, or both");
  option.HasNoEffect("loads", "with --figure urdf",
                     [&figure] { return *figure == render::Figure::kUrdf; });
  option("body_opacity", body_opacity,
         "opacity of people's bodies: below 1, what is in and behind them shows through");
  option.HasNoEffect("body_opacity", "with --style line", [&style, &body_opacity] {
    return *style == render::Style::kLine && *body_opacity < 1;
  });
  option.HasNoEffect("style", "with --figure urdf, whose parts have no lines", [&figure, &style] {
    return *figure == render::Figure::kUrdf && *style == render::Style::kLine;
  });
}

void PeopleLook::ApplyTo(render::SceneLook& look) const {
  look.figure = figure;
  look.style = style;
  look.loads = loads;
  look.body_opacity = body_opacity;
}

PeopleLook LoadPeopleLook(const FigureValue& figure, const StyleValue& style,
                          const LoadsShownValue& loads, const options::Number& body_opacity) {
  return {figure.Load(), *style, *loads, *body_opacity};
}

}  // namespace kinescope::app
