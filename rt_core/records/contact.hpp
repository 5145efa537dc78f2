// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/static_vector.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/triangle.hpp"
#include "rt_core/spm/ids.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

// Any thread: values, and functions of their arguments alone; no call waits or allocates.
namespace tactus
{

/// A face within a tool's radius of its core, or of one of its faces. Lengths and frame are those
/// of who has it.
struct Contact
{
    FaceId face{};
    TriangleFeature feature{TriangleFeature::interior}; ///< Of the face: where it is nearest.
    double distance_m{0.0};                             ///< From the core.
    Vec3 on_tool_m{0.0, 0.0, 0.0};                      ///< Of the core.
    Vec3 on_surface_m{0.0, 0.0, 0.0};
    /// Unit length, from the surface to the core; where they meet, the face's own. Zero where that
    /// has no area.
    Vec3 normal{0.0, 0.0, 0.0};
    FaceId tool_face{}; ///< Of a tool that is a mesh.
};

/// Nearest first, lower face ids first among equals, then lower ones of the tool's.
using ContactSet = StaticVector<Contact, kMaxContacts>;

/// Some faces of one another's kind: each lies behind a plane, and the core before it by at least
/// `distance_m`. Their planes' normals are within `spread` of this one.
struct ContactSlab
{
    Vec3 normal{0.0, 0.0, 0.0}; ///< Unit length, from the surface to the core.
    double distance_m{0.0};
    double spread{0.0}; ///< Length of the difference of two unit vectors.
};
/// Slabs of one pair, 40 B each. Enough for six sides in steps of 50 degrees; of more kinds of
/// faces some share a slab, whose spread grows.
inline constexpr std::size_t kMaxSlabs = 16;

/// Directions in which the farthest contacts are kept: along axes, between two and between three.
inline constexpr std::size_t kContactDirections = 26;

/// The farthest contact in each direction, so that a body that lies on hundreds of faces is held at
/// the ends of what it lies on. Far is also what would touch after a turn of a tenth: a contact
/// counts as nearer to the middle by ten times its distance from the core. Beyond the
/// contacts of a tool that is a mesh one pair of faces is measured in each direction: that which
/// might count as the farthest.
struct ContactEnds
{
    std::array<Contact, kContactDirections> contacts{};
    std::array<double, kContactDirections> reaches_m{};
    bool is_empty{true};
};

/// Where a tool with a force and a torque may come to touch an object, for the force stage. 10 KiB.
struct TouchReport
{
    ContactSet nearest;       ///< Of each face the nearest point.
    ContactSet corners;       ///< Of a convex core, over a face.
    ContactEnds ends;         ///< Of those and of all there was no room for.
    bool is_truncated{false}; ///< There were more.
    /// Of all faces nearer than `covered_m`, as far as they are exact.
    StaticVector<ContactSlab, kMaxSlabs> slabs;
    double covered_m{0.0};

    /// As new, without touching what no contact is in.
    void clear() noexcept
    {
        nearest.clear();
        corners.clear();
        ends.is_empty = true;
        is_truncated = false;
        slabs.clear();
        covered_m = 0.0;
    }
};

/// On which side of a closed surface a point is.
enum class Side : std::uint8_t
{
    unsigned_distance, ///< The mesh is open, the answer not exact, or the point on the surface.
    outside,           ///< Where the normals point to.
    inside,
};

/// What a tool that wants contacts gets of a pair; of a PairOutput in the world, metres. 3 KiB.
struct ContactReport
{
    ContactSet contacts;
    bool is_complete{false}; ///< No contact was left out, and none may exist unseen.
    /// Faces of which libccd said the opposite of what is proven; only convex bodies ask it.
    std::uint32_t overruled{0};
    /// Of the surface at the nearest point: a face's own, of an edge the mean of its faces', of a
    /// vertex weighted by their angles. Unit length; zero when it is not known.
    Vec3 normal{0.0, 0.0, 0.0};
    Side side{Side::unsigned_distance};

    /// As new, without touching what no contact is in.
    void clear() noexcept
    {
        contacts.clear();
        is_complete = false;
        overruled = 0;
        normal = Vec3(0.0, 0.0, 0.0);
        side = Side::unsigned_distance;
    }
};

} // namespace tactus
