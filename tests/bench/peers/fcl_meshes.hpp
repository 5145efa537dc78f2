// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

/// FCL behind plain numbers, in a separate shared library: it needs Eigen vectorised and aligned,
/// as in FCL's package. Our Eigen is not, so that definitions of FCL's headers must not meet ours.
namespace tactus::bench::fcl_meshes
{

using Point = std::array<double, 3>;

/// Transform from a mesh's own frame to the other's.
struct Place
{
    std::array<double, 9> rotation{}; ///< Rotation, column by column.
    Point origin{};
};

struct Nearest
{
    double distance{0.0}; ///< Distance from a sphere's surface; negative inside.
    Point on_mesh{};
};

/// Mesh as a BVHModel<OBBRSS<double>>.
class [[gnu::visibility("default")]] Mesh
{
public:
    /// Builds from three corners a face. Throws std::runtime_error if FCL refuses them.
    explicit Mesh(std::span<const std::array<Point, 3>> faces);
    Mesh(const Mesh&) = delete;
    Mesh& operator=(const Mesh&) = delete;
    ~Mesh();

    /// Result of collide() if it finds contacts, otherwise of distance(); a sphere without a radius
    /// uses distance() only.
    [[nodiscard]] Nearest nearest_to_sphere(const Point& center, double radius) const;

    [[nodiscard]] bool does_meet(const Place& place, const Mesh& other) const;
    /// Appends pairs of faces of this mesh and the other that meet; with contacts, FCL also
    /// computes where each pair touches and how deep.
    void find_meeting(const Place& place, const Mesh& other, bool with_contacts,
                      std::vector<std::array<std::uint32_t, 2>>& pairs) const;
    [[nodiscard]] double distance_to(const Place& place, const Mesh& other) const;

private:
    struct Content;
    std::unique_ptr<Content> content_;
};

} // namespace tactus::bench::fcl_meshes
