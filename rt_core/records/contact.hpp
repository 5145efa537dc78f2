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

/// A face within a tool's radius of its core, or of one of its faces. The owner of the record
/// defines lengths and frame.
struct Contact
{
    FaceId face{};
    TriangleFeature feature{TriangleFeature::interior}; ///< Nearest feature of the face.
    double distance_m{0.0};                             ///< Distance from the core.
    Vec3 on_tool_m{0.0, 0.0, 0.0};                      ///< Nearest point of the core.
    Vec3 on_surface_m{0.0, 0.0, 0.0};
    /// Unit length, from the surface to the core; where they meet, the face's own normal. Zero if
    /// that face has no area.
    Vec3 normal{0.0, 0.0, 0.0};
    FaceId tool_face{}; ///< The tool's face, if the tool is a mesh.
};

/// Nearest first; among equals lower ids of the object's faces first, then lower ids of the tool's.
using ContactSet = StaticVector<Contact, kMaxContacts>;

/// A group of faces with similar normals: each lies behind a plane, with the core in front of it at
/// `distance_m` or more. Their planes' normals are within `spread` of `normal`.
struct ContactSlab
{
    Vec3 normal{0.0, 0.0, 0.0}; ///< Unit length, from the surface to the core.
    double distance_m{0.0};
    double spread{0.0}; ///< Length of the difference of two unit vectors.
};
/// Slabs of one pair, 40 B each: enough for six sides in steps of 50 degrees. If there are more
/// kinds of faces, some share a slab, whose spread grows.
inline constexpr std::size_t kMaxSlabs = 16;

/// Directions in which the farthest contacts are kept: along axes, and between two or three of
/// them.
inline constexpr std::size_t kContactDirections = 26;

/// The farthest contact in each direction, so that a rigid tool that lies on hundreds of faces is
/// held at the ends of its support. Contacts that would touch after a rotation by a tenth count as
/// well: a contact counts as nearer to the middle by ten times its distance from the core. If the
/// tool is a mesh, one more pair of faces is measured in each direction: the one that might count
/// as the farthest.
struct ContactEnds
{
    std::array<Contact, kContactDirections> contacts{};
    std::array<double, kContactDirections> reaches_m{};
    bool is_empty{true};
};

/// Possible contacts of a tool with force and torque, for the force stage. 10 KiB.
struct TouchReport
{
    ContactSet nearest;       ///< The nearest point of each face.
    ContactSet corners;       ///< Corners of a convex core, over a face.
    ContactEnds ends;         ///< Ends of those and of all that did not fit.
    bool is_truncated{false}; ///< There were more.
    /// Slabs of all faces nearer than `covered_m`, if they are exact.
    StaticVector<ContactSlab, kMaxSlabs> slabs;
    double covered_m{0.0};

    /// Resets the report without writing unused contacts.
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

/// Side of a closed surface on which a point lies.
enum class Side : std::uint8_t
{
    unsigned_distance, ///< Mesh open, answer not exact, or point on the surface.
    outside,           ///< The side that the normals point to.
    inside,
};

/// Contacts of one pair, for a tool that asks for them. In a PairOutput: world frame, metres. 3
/// KiB.
struct ContactReport
{
    ContactSet contacts;
    bool is_complete{false}; ///< No contact was left out, and none may exist unseen.
    /// Faces for which libccd's answer contradicts the proof; only convex bodies use libccd.
    std::uint32_t overruled{0};
    /// Normal of the surface at the nearest point: a face's own, the mean of an edge's faces, or
    /// that of a vertex's faces weighted by their angles. Unit length; zero if unknown.
    Vec3 normal{0.0, 0.0, 0.0};
    Side side{Side::unsigned_distance};

    /// Resets the report without writing unused contacts.
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
