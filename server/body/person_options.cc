#include "server/body/person_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "core/errors.h"
#include "server/options/choose.h"
#include "urdf/placed_mass.h"

namespace kinescope::app {

std::string ToModelName(const std::string& text) {
  const bool is_good = !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  });
  if (!is_good) {
    throw UsageError(fmt::format("--model_name={}: expected letters, digits and _", text));
  }
  return text;
}

FigureChoice ToFigure(const PersonOptions& person) {
  FigureChoice figure;
  using Frame = urdf::MeshConvention::Frame;
  urdf::MeshConvention convention;
  convention.metres_per_unit =
      Choose<double>("mesh_units", person.mesh_units, {{"m", 1}, {"cm", 0.01}, {"mm", 0.001}});
  convention.y_is_up = Choose<bool>("mesh_up", person.mesh_up, {{"z", false}, {"y", true}});
  convention.fits_person =
      Choose<bool>("mesh_scale", person.mesh_scale, {{"fit", true}, {"none", false}});
  convention.frame = Choose<Frame>(
      "mesh_frame", person.mesh_frame,
      {{"auto", Frame::kLonger}, {"segment", Frame::kSegment}, {"link", Frame::kLink}});

  const std::string meshes = "mesh:";
  if (person.figure.rfind(meshes, 0) == 0 && person.figure.size() > meshes.size()) {
    figure.meshes = ReadFigureMeshes(person.figure.substr(meshes.size()), convention);
  } else if (person.figure != "smooth" && person.figure != "primitive") {
    throw UsageError(
        fmt::format("--figure={}: expected smooth, primitive or mesh:FOLDER", person.figure));
  }
  figure.is_smooth = person.figure != "primitive";
  figure.tools = ReadHandTools(person.tool, convention);
  return figure;
}

urdf::BodyDescription ToBody(const PersonOptions& person) {
  urdf::BodyDescription body;
  body.sex_is_assumed = !person.sex;
  if (person.sex) {
    body.sex = Choose<urdf::Sex>("sex", *person.sex,
                                 {{"male", urdf::Sex::kMale}, {"female", urdf::Sex::kFemale}});
  }
  body.mass_is_assumed = !person.mass;
  body.mass_kg = person.mass.value_or(body.sex == urdf::Sex::kMale ? 75 : 62);
  if (!urdf::FindDefect(body).empty()) {
    throw UsageError(fmt::format(
        "--mass={}: expected 20 to 300 kg; leave it out if it is not known", body.mass_kg));
  }
  try {
    body.table = urdf::ParseBodyTable(person.body_table);
  } catch (const std::invalid_argument& error) {
    throw UsageError(fmt::format("--body_table={}: {}", person.body_table, error.what()));
  }
  try {
    for (const std::string& text : SplitList(person.extra_mass)) {
      body.extra_masses.push_back(urdf::ParseExtraMass(text));
    }
    if (auto defect = urdf::FindDefect(body); !defect.empty()) throw std::invalid_argument(defect);
  } catch (const std::invalid_argument& error) {
    throw UsageError(fmt::format("--extra_mass={}: {}", person.extra_mass, error.what()));
  }
  return body;
}

}  // namespace kinescope::app
