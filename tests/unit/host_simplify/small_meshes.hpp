// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/simplify/simplify.hpp"
#include "tests/shared/brute_force.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace tactus::test
{

/// Closed sphere with 20 n^2 faces, at least 180; radial noise as a share of the radius.
[[nodiscard]] QuantisedMesh make_sphere(std::uint32_t faces, double noise);

/// Closed, with two poles of valence `sectors`; (rings - 1) x sectors x 2 faces.
[[nodiscard]] QuantisedMesh make_needle_sphere(std::uint32_t rings, std::uint32_t sectors);

/// Open height field over columns x rows squares.
[[nodiscard]] QuantisedMesh make_grid(unsigned columns, unsigned rows,
                                      const std::function<double(double, double)>& height);

/// The same without a face of every third square of every third row.
[[nodiscard]] QuantisedMesh make_scan(unsigned columns, unsigned rows,
                                      const std::function<double(double, double)>& height);

/// Closed flat sheet of genus holes^2, with that many square holes.
[[nodiscard]] QuantisedMesh make_perforated(unsigned holes);

/// Closed torus of genus 1.
[[nodiscard]] QuantisedMesh make_torus(std::uint32_t faces);

/// Open cone: an apex of valence `sectors` over `rings` rings.
[[nodiscard]] QuantisedMesh make_cone(unsigned rings, unsigned sectors);

/// Components at random places that cannot shrink: separate triangles, and tetrahedra, as many as
/// pairs of opposite faces.
[[nodiscard]] QuantisedMesh make_crumbs(std::uint32_t triangles, std::uint32_t solids);

/// Both meshes, the second moved along x.
[[nodiscard]] QuantisedMesh join(const QuantisedMesh& a, const QuantisedMesh& b,
                                 std::int32_t shift);

struct NamedMesh
{
    std::string name;
    QuantisedMesh mesh;
};

/// One small mesh of each kind: closed, open, with holes, high valence, coincident vertices, faces
/// without area, several components.
[[nodiscard]] const std::vector<NamedMesh>& all_small_meshes();

/// Some faces over the mesh's vertices, in quanta.
[[nodiscard]] std::vector<Face> faces_of(const QuantisedMesh& mesh,
                                         std::span<const std::array<std::uint32_t, 3>> faces);

/// Simplification of a mesh that must be accepted: throws the refusal.
[[nodiscard]] Simplification simplified(const QuantisedMesh& mesh, std::uint32_t base_faces = 40,
                                        unsigned threads = 1);

} // namespace tactus::test
