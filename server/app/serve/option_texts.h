/// Options of other commands of this program as texts, for what the server starts. Pure functions,
/// any thread.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "server/options/option_list.h"
#include "server/picture/backend.h"
#include "server/picture/view_options.h"
#include "server/scene/scene_options.h"

namespace kinescope::app {

/// Name and value.
using OptionTexts = std::vector<std::pair<std::string, std::string>>;

/// Those of the person and the loads that differ from their defaults: for `kinescope loads` and
/// `render`.
OptionTexts LoadsOptionsOf(const PersonOptions& person, const LoadOptions& loads);

/// Those of pictures that differ from their defaults: for `kinescope render`.
OptionTexts PictureOptionsOf(const ViewOptions& view, const BackendOptions& backend);

/// In the place of one of the same name, or added.
void SetOption(OptionTexts& options, const std::string& name, const std::string& value);

/// "name=value", one per line, and back. Lines that name no option of the person or the loads are
/// left out: they come from a file.
std::string ToLines(const OptionTexts& options);
OptionTexts OptionsFromLines(const std::string& lines);

}  // namespace kinescope::app
