/// JSON whose members keep their order: what people read and what is compared as text.
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace kinescope::app {

using Json = nlohmann::ordered_json;

}  // namespace kinescope::app
