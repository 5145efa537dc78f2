// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/strong_id.hpp"

namespace tactus
{

/// A model's place in the controller's list.
using ModelId = StrongId<struct ModelTag>;

} // namespace tactus
