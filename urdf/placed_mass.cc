#include "urdf/placed_mass.h"

#include <algorithm>
#include <cmath>
#include <locale>
#include <sstream>
#include <stdexcept>

namespace kinescope::urdf {
namespace {

double ReadNumber(const std::string& text) {
  std::istringstream in(text);
  in.imbue(std::locale::classic());
  double value = 0;
  char rest = 0;
  if (!(in >> value) || in >> rest || !std::isfinite(value)) {
    throw std::invalid_argument("'" + text + "' is not a number");
  }
  return value;
}

Eigen::Vector3d ReadPlace(const std::string& text) {
  const std::vector<double> numbers = ParseNumbers(text);
  if (numbers.size() != 3) throw std::invalid_argument("'" + text + "' is not X,Y,Z");
  return {numbers[0], numbers[1], numbers[2]};
}

}  // namespace

std::vector<double> ParseNumbers(const std::string& text) {
  std::vector<double> numbers;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    numbers.push_back(ReadNumber(text.substr(begin, end - begin)));
    begin = end + 1;
  }
  return numbers;
}

PlacedMass ParsePlacedMass(const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos || colon == 0) {
    throw std::invalid_argument("'" + text + "' is not NAME:KG");
  }
  const std::size_t at = text.find('@', colon);
  PlacedMass placed;
  placed.where = text.substr(0, colon);
  placed.mass_kg =
      ReadNumber(text.substr(colon + 1, at == std::string::npos ? at : at - colon - 1));
  if (at != std::string::npos) placed.position = ReadPlace(text.substr(at + 1));
  return placed;
}

}  // namespace kinescope::urdf
