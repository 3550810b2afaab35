#include "server/picture/figure_value.h"

#include <mutex>
#include <stdexcept>

#include "core/system/errors.h"
#include "core/system/starts_with.h"
#include "server/body/own_skin.h"

namespace kinescope::app {
namespace {

constexpr char kOwnSkin[] = "skin:";

}  // namespace

struct FigureValue::OwnSkin {
  std::once_flag is_read;
  std::shared_ptr<const skin::SkinTemplate> skin;
};

void FigureValue::Parse(const std::string& text) {
  const std::string own = kOwnSkin;
  if (text == "skin" || text == "urdf") {
    *this = text == "urdf" ? render::Figure::kUrdf : render::Figure::kSkin;
  } else if (StartsWith(text, own) && text.size() > own.size()) {
    *this = render::Figure::kSkin;
    file_ = text.substr(own.size());
    own_ = std::make_shared<OwnSkin>();
  } else {
    RefuseText();
  }
}

std::string FigureValue::ToText() const {
  if (!file_.empty()) return kOwnSkin + file_;
  return value_.kind == render::Figure::kUrdf ? "urdf" : "skin";
}

std::vector<std::filesystem::path> FigureValue::Files() const {
  std::error_code ignored;
  if (file_.empty() || !std::filesystem::is_regular_file(file_, ignored)) return {};
  return {file_};
}

void FigureValue::SetFolder(const std::filesystem::path& folder) {
  if (!file_.empty()) file_ = (folder / file_).string();
}

render::Figure FigureValue::Load() const {
  render::Figure figure = value_;
  if (!own_) return figure;
  try {
    std::call_once(own_->is_read, [&] { own_->skin = ReadOwnSkin(file_); });
  } catch (const std::runtime_error& error) {
    throw UsageError("--figure=" + ToText() + ": " + error.what());
  }
  figure.own_skin = own_->skin;
  return figure;
}

}  // namespace kinescope::app
