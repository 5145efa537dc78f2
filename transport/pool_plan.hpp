// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/frame/frame_setup.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace tactus
{

/// Plans the capacities of each model so that a frame, all pools and the ChunkLoader fit into
/// `bytes` of an arena, with `cache_bytes` for pages (0: the usual share). `setup.models` is
/// ignored. ModelCapacities::edit_faces is an input. False if they do not fit; `capacities` is then
/// unspecified.
[[nodiscard]] bool try_plan_pools(const FrameSetup& setup, std::span<const ModelHeader> headers,
                                  std::size_t bytes, std::size_t cache_bytes,
                                  std::span<ModelCapacities> capacities);

/// Plans memory for streamed models, of which only the headers are resident at the start. Pages get
/// 60 % of the memory beyond the minimum, unless `cache_bytes` is given. The remainder determines
/// the number of base meshes resident at once, at least one of the largest size.
[[nodiscard]] bool try_plan_streamed_models(const FrameSetup& setup,
                                            std::span<const ModelHeader> headers, std::size_t bytes,
                                            std::size_t cache_bytes, ModelCapacities& room);

/// Smallest `bytes` for which try_plan_pools() succeeds, rounded up to 64 KiB; 0 if 1 TiB is not
/// enough. `edit_faces` is ModelCapacities::edit_faces of each model, or empty for none.
[[nodiscard]] std::size_t least_pool_bytes(const FrameSetup& setup,
                                           std::span<const ModelHeader> headers,
                                           std::size_t cache_bytes,
                                           std::span<const std::uint32_t> edit_faces = {});

} // namespace tactus
