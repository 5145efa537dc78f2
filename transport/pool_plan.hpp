// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/frame/frame_setup.hpp"

#include <cstddef>
#include <span>

namespace tactus
{

/// Plans the capacities of the models, one each, so that a frame, all pools and the ChunkLoader
/// that fills them fit into `bytes` of an arena. `cache_bytes` of these are for pages (0: the usual
/// share). `setup.models` is ignored. False if they do not fit; `capacities` is then unspecified.
[[nodiscard]] bool try_plan_pools(const FrameSetup& setup, std::span<const ModelHeader> headers,
                                  std::size_t bytes, std::size_t cache_bytes,
                                  std::span<ModelCapacities> capacities);

/// Plans the room for streamed models: none of `setup.models` is resident at the start, and only
/// their headers are known. Pages get three fifths of the optional memory; as many base meshes as
/// fit are resident at once, at least the largest one.
[[nodiscard]] bool try_plan_streamed_models(const FrameSetup& setup,
                                            std::span<const ModelHeader> headers, std::size_t bytes,
                                            std::size_t cache_bytes, ModelCapacities& room);

/// Least number of bytes for which try_plan_pools() has a plan, rounded up to 64 KiB; 0 if a
/// tebibyte is not enough.
[[nodiscard]] std::size_t least_pool_bytes(const FrameSetup& setup,
                                           std::span<const ModelHeader> headers,
                                           std::size_t cache_bytes);

} // namespace tactus
