/// One picture that explains a difference without any other context: words, the accepted picture,
/// the new one and their difference, and the worst of it enlarged. For servers that show one
/// picture per test. Pure but for the font; one thread.
#pragma once

#include <optional>

#include "render/image/image.h"
#include "render/image/tile.h"
#include "server/app/golden/golden_verdict.h"

namespace kinescope::app {

/// @pre the pictures have one size. @throws render::RenderError if the font is missing.
render::Image Composite(const CaseVerdict& verdict, const render::Image& accepted,
                        const render::Image& now, const render::Image& difference);

/// The part of the picture of a verdict that is worth enlarging; nullopt: no finding has a place.
std::optional<render::Tile> WorstPart(const CaseVerdict& verdict);

}  // namespace kinescope::app
