// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Among the sources of a test program: every frame rig in it validates its models. How often says
/// the program's CMakeLists.txt.
#include "tests/shared/frame_rig.hpp"

namespace tactus::test
{
namespace
{

[[maybe_unused]] const bool is_on = (FrameRig::validate_every(TACTUS_VALIDATED_EVERY), true);

} // namespace
} // namespace tactus::test
