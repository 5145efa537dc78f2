// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/simplify/surface_samples.hpp"

namespace tactus
{

void SurfaceSamples::start(std::span<const std::uint32_t> present, std::size_t face_count)
{
    slot_.assign(face_count, Collapse::kNoFace);
    faces_.assign(present.size(), {});
    for (std::uint32_t slot = 0; slot < present.size(); ++slot)
    {
        slot_[present[slot]] = slot;
    }
}

void SurfaceSamples::gather(std::span<const std::uint32_t> faces, StarSamples& star) const
{
    star.points.clear();
    star.areas.clear();
    for (const std::uint32_t face : faces)
    {
        for (const SurfacePoint& point : faces_[slot_[face]])
        {
            star.points.push_back({static_cast<double>(point.x), static_cast<double>(point.y),
                                   static_cast<double>(point.z)});
            star.areas.push_back(static_cast<double>(point.area));
        }
    }
}

} // namespace tactus
