// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

/// FCL behind plain numbers, in a shared library of its own: it needs Eigen as FCL's package was
/// built with it, vectorised and aligned. Ours is not, so what FCL's headers define must not meet
/// what ours do.
namespace tactus::bench::fcl_meshes
{

using Point = std::array<double, 3>;

/// From a mesh's own frame into the other's.
struct Place
{
    std::array<double, 9> rotation{}; ///< Column by column.
    Point origin{};
};

struct Nearest
{
    double distance{0.0}; ///< From a sphere's surface; negative inside.
    Point on_mesh{};
};

/// A BVHModel<OBBRSS<double>>.
class [[gnu::visibility("default")]] Mesh
{
public:
    /// Three corners a face. Throws std::runtime_error when FCL refuses them.
    explicit Mesh(std::span<const std::array<Point, 3>> faces);
    Mesh(const Mesh&) = delete;
    Mesh& operator=(const Mesh&) = delete;
    ~Mesh();

    /// By collide(), where it finds contacts, else by distance(); a sphere without a radius is
    /// asked for its distance alone.
    [[nodiscard]] Nearest nearest_to_sphere(const Point& center, double radius) const;

    [[nodiscard]] bool does_meet(const Place& place, const Mesh& other) const;
    /// Places of faces of this mesh and of the other that meet; FCL computes where each two touch,
    /// and how deep, when it is asked to.
    void find_meeting(const Place& place, const Mesh& other, bool with_contacts,
                      std::vector<std::array<std::uint32_t, 2>>& pairs) const;
    [[nodiscard]] double distance_to(const Place& place, const Mesh& other) const;

private:
    struct Content;
    std::unique_ptr<Content> content_;
};

} // namespace tactus::bench::fcl_meshes
