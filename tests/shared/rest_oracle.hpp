// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/similarity.hpp"
#include "rt_core/math/vec3.hpp"
#include "tests/shared/solid_cores.hpp"

#include <vector>

namespace tactus::test
{

/// Two springs between hand and tool, both about the tool's origin.
struct Springs
{
    double stiffness_n_per_m{500.0};
    double stiffness_nm_per_rad{1.0};
};

/// Rest position of a tool that springs pull while its core keeps its radius from every face.
struct Rest
{
    Similarity place;
    Vec3 force_n{0.0, 0.0, 0.0};
    Vec3 torque_nm{0.0, 0.0, 0.0};
    double deepest_m{0.0}; ///< Greatest remaining penetration of the radius.
    int faces{0};          ///< Faces in contact.
};

/// Truth about a rigid tool at rest, by brute force: the energy of the springs is minimised over
/// all translations and rotations, with every pair of a core face and a source face that could
/// touch measured by corners and edges. Penetration of the radius costs like a spring up to a
/// million times as stiff, in steps; Levenberg-Marquardt with numerical derivatives. Of the product
/// it uses only the shapes: no planes, contacts or proxy.
///
/// It finds the rest next to `near`, so faces farther than 2 mm from the tool's radius there are
/// ignored.
[[nodiscard]] Rest rest_of(const SolidCore& tool, const std::vector<Face>& faces,
                           const Springs& springs, const Similarity& hand, const Similarity& near);

} // namespace tactus::test
