// The program line that a coordinate system executes, as `PE` and `LIST PE` report it, made by the image's own
// functions.
#pragma once

#include <nlohmann/json.hpp>

#include "app/page/image_calls.h"

namespace brick {

// `at`: where it stands, and `text`; null where nothing executes. `system` counts from 1.
nlohmann::json executing_line(ImageCalls& image, unsigned system);

}  // namespace brick
