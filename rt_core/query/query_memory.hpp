// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/abtree/node.hpp"

#include <cstdint>

namespace tactus
{

/// Memory of a pair of tool and object between queries: where the next search begins.
struct QueryMemory
{
    std::uint32_t block{kNoNode}; ///< Block of the last nearest face; any value is safe.
    float limit{0.0F}; ///< Last upper bound on a point's distance, in quanta; any value is safe.
};

} // namespace tactus
