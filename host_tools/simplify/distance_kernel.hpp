// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstddef>
#include <span>

namespace tactus
{

// NOLINTBEGIN(cppcoreguidelines-avoid-c-arrays,modernize-avoid-c-arrays): distance_kernel.inc.

/// One side of a triangle.
struct KernelSide
{
    double start[3];
    double along[3];
    double inward[3]; ///< Direction in the plane towards the third corner; zero without area.
    double inverse_squared_length;
};

/// A triangle as the distance kernel reads it.
struct KernelTriangle
{
    KernelSide sides[3];
    double normal[3]; ///< Normal; its length is twice the area.
    double inverse_squared_normal;
};

// NOLINTEND(cppcoreguidelines-avoid-c-arrays,modernize-avoid-c-arrays)

/// Writes the squared distances of the points begin .. end - 1 to the same places of `out`.
/// Compiled once for each instruction set; all give the same bits, since each point's operations
/// are the same IEEE operations in the same order.
using SquaredDistances = void (*)(const KernelTriangle& triangle, const double* x, const double* y,
                                  const double* z, std::size_t begin, std::size_t end,
                                  double* out) noexcept;

extern const SquaredDistances kPortableSquaredDistances;
extern const SquaredDistances kAvx2SquaredDistances; ///< Exists only with TACTUS_HAS_X86_KERNELS.

/// Kernels that this processor supports, the fastest last.
[[nodiscard]] std::span<const SquaredDistances> available_distance_kernels() noexcept;

} // namespace tactus
