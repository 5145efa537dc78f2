// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/triangle_mesh.hpp"

#include <cstdint>

namespace tactus::detail
{

/// Two triangles for each cell of a columns x rows grid of vertices, which are the mesh's first
/// ones. An axis may wrap. A face's normal is the cross product of column axis and row axis.
/// `columns` and `rows` count vertices, so an axis that does not wrap has one cell less.
struct Grid
{
    std::uint32_t columns{0};
    std::uint32_t rows{0};
    bool wrap_columns{false};
    bool wrap_rows{false};

    [[nodiscard]] std::uint32_t vertex(std::uint32_t c, std::uint32_t r) const
    {
        return (c % columns) * rows + r % rows;
    }

    void add_faces(TriangleMesh& mesh) const
    {
        const std::uint32_t column_cells = wrap_columns ? columns : columns - 1;
        const std::uint32_t row_cells = wrap_rows ? rows : rows - 1;
        for (std::uint32_t c = 0; c < column_cells; ++c)
        {
            for (std::uint32_t r = 0; r < row_cells; ++r)
            {
                const std::uint32_t a = vertex(c, r);
                const std::uint32_t b = vertex(c + 1, r);
                const std::uint32_t d = vertex(c + 1, r + 1);
                const std::uint32_t e = vertex(c, r + 1);
                mesh.faces.push_back({a, b, d});
                mesh.faces.push_back({a, d, e});
            }
        }
    }
};

} // namespace tactus::detail
