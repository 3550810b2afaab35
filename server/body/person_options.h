/// The person in the suit, as options say it.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "server/body/figure_meshes.h"
#include "server/body/hand_tools.h"
#include "urdf/body_parameters.h"

namespace kinescope::app {

/// Who is in the suit, and how they are shown.
struct PersonOptions {
  std::string model_name = "skeleton";
  // What nobody gave is assumed, and is said to be wherever it is shown.
  std::optional<std::string> sex;
  std::optional<double> mass, height;
  std::string body_table = urdf::Name(urdf::BodyDescription().table);
  std::string extra_mass;
  std::string figure = "smooth";
  std::string tool;
  std::string mesh_units = "m";
  std::string mesh_up = "z";
  std::string mesh_scale = "fit";
  std::string mesh_frame = "auto";

  template <class Option>
  void Visit(Option&& option) {
    option("model_name", model_name, "prefix of links, joints and TF frames");
    option("sex", sex, "male or female: body table and strength; not given: male is assumed");
    option("mass", mass, "body mass, kg; not given: 75 (male) or 62 (female) is assumed");
    option("height", height,
           "stature, m, until the suit tells its own segment lengths; not given: 1.75 is assumed");
    option("body_table", body_table,
           "masses of segments by: de_leva, winter, dumas or iit (docs/loads.md)");
    option("extra_mass", extra_mass,
           "worn or carried: SEGMENT:KG or SEGMENT:KG@X,Y,Z (m, in the link's frame), several with "
           "commas between, such as head:1.5,t8:8@-0.15,0,0.1");
    option(
        "figure", figure,
        "smooth, primitive (boxes, cylinders, spheres) or mesh:FOLDER (your own STL, DAE, OBJ or "
        "GLB files, named after segments, such as RightForeArm.stl)");
    option("tool", tool,
           "mesh of what is held: right:FILE or left:FILE (STL, DAE, OBJ or GLB), its origin at "
           "the grip, or FILE@X,Y,Z or FILE@X,Y,Z,ROLL,PITCH,YAW (m and rad, in the hand's link "
           "frame), with ; between two. What it weighs, and where, is told by hand");
    option("mesh_units", mesh_units, "of your own STL and OBJ files: m, cm or mm");
    option("mesh_up", mesh_up, "likewise, the axis that points up: z or y");
    option("mesh_scale", mesh_scale,
           "fit (meshes stretched along their segments to the person's own lengths) or none");
    option(
        "mesh_frame", mesh_frame,
        "how arm meshes lie: segment (along y, T-pose), link (along -z, N-pose) or auto (as they "
        "are longer)");
  }
};

/// How a person is drawn.
struct FigureChoice {
  bool is_smooth = true;                       // mesh files; false: boxes, cylinders and spheres
  std::shared_ptr<const FigureMeshes> meshes;  // instead of ours; null: ours
  std::shared_ptr<const HandTools> tools;      // in everybody's hands; null: none
};

// All: @throws UsageError naming option, value and what was expected.
urdf::BodyDescription ToBody(const PersonOptions& person);
/// Reads the meshes.
FigureChoice ToFigure(const PersonOptions& person);
/// Links, joints and TF frames have it in their names.
std::string ToModelName(const std::string& text);

}  // namespace kinescope::app
