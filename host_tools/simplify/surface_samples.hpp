// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/simplify/point_triangle.hpp"
#include "host_tools/simplify/simplify.hpp"
#include "rt_core/base/static_vector.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tactus
{

/// A point of the original surface, in quanta, and the area that it represents, in quanta^2. Single
/// precision suffices: samples only rank collapses.
struct SurfacePoint
{
    float x;
    float y;
    float z;
    float area;
};

/// Samples of the surface assigned to one face; more per face give no gain.
using FaceSamples = StaticVector<SurfacePoint, 6>;

/// Points that represent the original surface near a vertex.
struct StarSamples
{
    PointColumns points;
    std::vector<double> areas; ///< Areas in quanta^2.
};

/// Samples of each face that was present at start(). Ranking the collapses of a star thus reads a
/// few lines of memory instead of all pieces of its faces. About 100 B a face.
class SurfaceSamples
{
public:
    /// Makes room for samples of the faces in `present`; `face_count` is the number of faces of the
    /// mesh.
    void start(std::span<const std::uint32_t> present, std::size_t face_count)
    {
        slot_.assign(face_count, Collapse::kNoFace);
        faces_.assign(present.size(), {});
        for (std::uint32_t slot = 0; slot < present.size(); ++slot)
        {
            slot_[present[slot]] = slot;
        }
    }

    /// Sets the samples of a face. Threads may set different faces at the same time.
    void set(std::uint32_t face, const FaceSamples& samples) { faces_[slot_[face]] = samples; }

    /// Fills `star` with the samples of the faces.
    void gather(std::span<const std::uint32_t> faces, StarSamples& star) const
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

private:
    std::vector<std::uint32_t> slot_; ///< Index into `faces_`, by face of the mesh.
    std::vector<FaceSamples> faces_;
};

} // namespace tactus
