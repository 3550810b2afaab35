// What a live picture costs with more people, more views and more pixels: growth [FIGURE.svg]. Each
// case runs in a process of its own, so that its peak of memory is known. CPU time is of all
// threads. Prints tables, as README.md has them.
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "render/camera/camera.h"
#include "render/plot.h"
#include "render/renderer.h"
#include "server/scene/scene_options.h"
#include "server/scene/scene_reader.h"
#include "tests/bench/cpu_time.h"

namespace {

using namespace kinescope;

struct Case {
  int people = 1, views = 1, width = 1280, height = 720, supersample = 1;
};
struct Cost {
  double cpu_ms = 0, peak_mb = 0;
};

// As far apart as people at work, in rows.
SceneState Crowd(const SceneState& one, int people) {
  constexpr double kApart = 1.2;  // m
  const int columns = static_cast<int>(std::ceil(std::sqrt(people)));
  SceneState state = one;
  state.people.clear();
  for (int i = 0; i < people; ++i) {
    PersonState person = one.people.at(0);
    person.character = i;
    const Eigen::Vector3d by(kApart * (i / columns), kApart * (i % columns), 0);
    for (urdf::Pose& pose : person.links) pose.position += by;
    for (JointLoad& load : person.loads) load.position += by;
    for (FootForce& foot : person.forces.feet) foot.cop += by;
    if (person.com) *person.com += by;
    if (person.cop) *person.cop += by;
    state.people.push_back(std::move(person));
  }
  return state;
}

Cost Measure(const Case& of) {
  constexpr int kFirst = 5, kPictures = 40;
  app::SceneReader reader("demo:lift", app::ToShownSceneOptions(app::PersonOptions()));
  std::vector<SceneState> states;
  for (int i = 0; i < kPictures; ++i) {
    for (int skipped = 0; skipped < 3; ++skipped) reader.Next();
    states.push_back(Crowd(*reader.Next(), of.people));
  }
  render::PictureSpec spec;
  spec.width = of.width;
  spec.height = of.height;
  spec.supersample = of.supersample;
  spec.look.detail = render::Detail::kBySize;
  const auto& names = render::CameraNames();
  const auto camera = render::NamedCamera("three_quarter", states.front());
  spec.pane_columns = static_cast<int>(std::ceil(std::sqrt(of.views)));
  for (int i = 0; i < of.views && of.views > 1; ++i) {
    const std::string& name = names[static_cast<std::size_t>(i) % names.size()];
    spec.panes.push_back({name, render::NamedCamera(name, states.front())});
  }
  const auto renderer = render::MakeRenderer();
  render::Image image;
  for (int i = 0; i < kFirst; ++i) renderer->RenderInto(image, states.front(), camera, spec);
  const double before = CpuSecs();
  for (const SceneState& state : states) renderer->RenderInto(image, state, camera, spec);
  Cost cost;
  cost.cpu_ms = 1000 * (CpuSecs() - before) / kPictures;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  cost.peak_mb = static_cast<double>(usage.ru_maxrss) / 1024;
  return cost;
}

Cost MeasureApart(const std::string& program, const Case& of) {
  const std::string command = "'" + program + "' --case " + std::to_string(of.people) + " " +
                              std::to_string(of.views) + " " + std::to_string(of.width) + " " +
                              std::to_string(of.height) + " " + std::to_string(of.supersample);
  Cost cost;
  std::FILE* const pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return cost;
  if (std::fscanf(pipe, "%lf %lf", &cost.cpu_ms, &cost.peak_mb) != 2) cost = Cost();
  pclose(pipe);
  return cost;
}

struct Series {
  std::string title;
  std::vector<double> x;
  std::vector<Case> cases;
};

std::vector<Series> AllSeries() {
  Series people{"people", {}, {}}, views{"views in a picture", {}, {}},
      pixels{"megapixels", {}, {}};
  for (const int count : {1, 2, 4, 8, 16}) {
    people.x.push_back(count);
    people.cases.push_back({count});
  }
  for (const int count : {1, 2, 4, 8}) {
    views.x.push_back(count);
    views.cases.push_back({1, count});
  }
  for (const int height : {360, 720, 1080, 1440, 2160}) {
    const int width = height * 16 / 9;
    pixels.x.push_back(1e-6 * width * height);
    pixels.cases.push_back({1, 1, width, height});
  }
  return {people, views, pixels};
}

render::PlotPanel PanelOf(const Series& series, std::size_t column, bool is_memory) {
  render::PlotPanel panel;
  panel.left = 46 + 172.0 * static_cast<double>(column);
  panel.top = is_memory ? 172 : 22;
  panel.width = 120;
  panel.height = 108;
  panel.x_label = series.title;
  panel.y_label = is_memory ? "peak memory, MB" : "CPU ms a picture";
  panel.x_from = 0;
  panel.x_to = 1.05 * series.x.back();
  panel.y_to = 0;
  return panel;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 7 && std::string(argv[1]) == "--case") {
    const auto number = [&](int i) { return std::atoi(argv[i]); };
    const Cost cost = Measure({number(2), number(3), number(4), number(5), number(6)});
    std::printf("%f %f\n", cost.cpu_ms, cost.peak_mb);
    return 0;
  }
  const std::array<Rgb, 2> colors = {{{0.13, 0.40, 0.67}, {0.80, 0.36, 0.08}}};
  render::Plot plot;
  plot.width = 530;
  plot.height = 316;
  const std::vector<Series> all = AllSeries();
  for (std::size_t column = 0; column < all.size(); ++column) {
    const Series& series = all[column];
    render::PlotPanel cpu = PanelOf(series, column, false), memory = PanelOf(series, column, true);
    std::printf("\n| %s | CPU a picture, 1x | 2x | peak memory, 1x | 2x |\n|---|---|---|---|---|\n",
                series.title.c_str());
    std::vector<std::array<Cost, 2>> costs;
    for (std::size_t i = 0; i < series.cases.size(); ++i) {
      auto& both = costs.emplace_back();
      for (const int supersample : {1, 2}) {
        Case each = series.cases[i];
        each.supersample = supersample;
        both[static_cast<std::size_t>(supersample - 1)] = MeasureApart(argv[0], each);
      }
      std::printf("| %.3g | %.1f ms | %.1f ms | %.0f MB | %.0f MB |\n", series.x[i], both[0].cpu_ms,
                  both[1].cpu_ms, both[0].peak_mb, both[1].peak_mb);
      std::fflush(stdout);
    }
    for (std::size_t which = 0; which < 2; ++which) {
      render::PlotCurve time, space;
      time.color = space.color = colors[which];
      if (column == 0) time.name = which == 0 ? "1x" : "2x supersampled";
      for (std::size_t i = 0; i < costs.size(); ++i) {
        time.points.emplace_back(series.x[i], costs[i][which].cpu_ms);
        space.points.emplace_back(series.x[i], costs[i][which].peak_mb);
        cpu.y_to = std::max(cpu.y_to, 1.1 * costs[i][which].cpu_ms);
        memory.y_to = std::max(memory.y_to, 1.1 * costs[i][which].peak_mb);
      }
      cpu.curves.push_back(std::move(time));
      memory.curves.push_back(std::move(space));
    }
    plot.panels.push_back(std::move(cpu));
    plot.panels.push_back(std::move(memory));
  }
  if (argc > 1) std::ofstream(argv[1]) << render::ToSvg(plot);
  return 0;
}
