// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/strong_id.hpp"

// Any thread: values, and functions of their arguments alone; no call waits or allocates.
namespace tactus
{

/// A model's place in the controller's list, FrameSetup::models, from 0.
using ModelId = StrongId<struct ModelTag>;

} // namespace tactus
