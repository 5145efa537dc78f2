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

/// A point of the original surface and the area that it represents, in quanta. Single precision
/// suffices: samples only rank collapses.
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

/// Keeps each present face's samples, so that ranking the collapses of a star reads a few lines of
/// memory instead of all pieces of its faces. Present means at the start. About 100 B a face.
class SurfaceSamples
{
public:
    /// Makes room for the faces in `present`, of `face_count` in the mesh.
    void start(std::span<const std::uint32_t> present, std::size_t face_count);

    /// Different faces may be set at the same time.
    void set(std::uint32_t face, const FaceSamples& samples) { faces_[slot_[face]] = samples; }

    /// Fills `star` with the samples of the faces.
    void gather(std::span<const std::uint32_t> faces, StarSamples& star) const;

private:
    std::vector<std::uint32_t> slot_; ///< Slot by face of the mesh.
    std::vector<FaceSamples> faces_;
};

} // namespace tactus
