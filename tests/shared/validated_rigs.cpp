// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Source of test programs in which every frame rig validates its models; the interval is in the
/// program's CMakeLists.txt.
#include "tests/shared/frame_rig.hpp"

namespace tactus::test
{
namespace
{

[[maybe_unused]] const bool is_on = (FrameRig::validate_every(TACTUS_VALIDATED_EVERY), true);

} // namespace
} // namespace tactus::test
