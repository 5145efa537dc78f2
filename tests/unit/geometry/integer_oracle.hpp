// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace tactus::test
{

__extension__ using Integer = __int128;
using GridPoint = std::array<std::int64_t, 3>;
using GridTriangle = std::array<GridPoint, 3>;

/// Exact test whether a linear system has a solution without negative numbers. Shapes with corners
/// on a grid share a point if and only if each has weights that add up to one and give the same
/// point. If there is such a solution there is one on independent columns, and all of those are
/// tried. No planes, sides or axes are involved. For coordinates up to 100.
struct LinearSystem
{
    static constexpr std::size_t kMaxRows = 7;
    static constexpr std::size_t kMaxColumns = 9;
    using Column = std::array<std::int64_t, kMaxRows>;

    explicit LinearSystem(std::size_t rows) : rows_(rows) {}

    void add_column(const Column& column) { columns_[count_++] = column; }
    void set_right(std::size_t row, std::int64_t value) { right_[row] = value; }

    [[nodiscard]] bool has_solution() const
    {
        for (unsigned chosen = 1; chosen < (1U << count_); ++chosen)
        {
            if (static_cast<std::size_t>(std::popcount(chosen)) <= rows_ && has_solution_on(chosen))
            {
                return true;
            }
        }
        return false;
    }

private:
    using Row = std::array<std::int64_t, kMaxColumns + 1>;
    using Table = std::array<Row, kMaxRows>;

    /// Gauss-Jordan without fractions (Bareiss): all numbers remain minors of the system.
    [[nodiscard]] bool has_solution_on(unsigned chosen) const
    {
        Table table = table_of(chosen);
        const auto unknowns = static_cast<std::size_t>(std::popcount(chosen));
        std::int64_t pivot = 1;
        for (std::size_t k = 0; k < unknowns; ++k)
        {
            std::size_t found = k;
            while (found < rows_ && table[found][k] == 0)
            {
                ++found;
            }
            if (found == rows_)
            {
                return false; // Dependent: fewer columns suffice.
            }
            std::swap(table[k], table[found]);
            for (std::size_t row = 0; row < rows_; ++row)
            {
                eliminate(table[k], k, unknowns, pivot, table[row], row == k);
            }
            pivot = table[k][k];
        }
        return is_solved(table, unknowns);
    }

    /// Chosen columns with the right side.
    [[nodiscard]] Table table_of(unsigned chosen) const
    {
        Table table{};
        for (std::size_t row = 0; row < rows_; ++row)
        {
            std::size_t at = 0;
            for (std::size_t column = 0; column < count_; ++column)
            {
                if ((chosen >> column & 1U) != 0)
                {
                    table[row][at++] = columns_[column][row];
                }
            }
            table[row][at] = right_[row];
        }
        return table;
    }

    static void eliminate(const Row& by, std::size_t k, std::size_t unknowns,
                          std::int64_t last_pivot, Row& row, bool is_pivot_row)
    {
        const std::int64_t factor = row[k];
        for (std::size_t column = 0; column <= unknowns && !is_pivot_row; ++column)
        {
            row[column] = (row[column] * by[k] - factor * by[column]) / last_pivot;
        }
    }

    [[nodiscard]] bool is_solved(const Table& table, std::size_t unknowns) const
    {
        for (std::size_t row = 0; row < rows_; ++row)
        {
            const std::int64_t value = table[row][unknowns];
            const bool is_negative =
                row < unknowns && value != 0 && (value < 0) != (table[row][row] < 0);
            if ((row >= unknowns && value != 0) || is_negative)
            {
                return false;
            }
        }
        return true;
    }

    std::size_t rows_;
    std::size_t count_{0};
    std::array<Column, kMaxColumns> columns_{};
    Column right_{};
};

/// True if two or three corners and a triangle share a point.
[[nodiscard]] inline bool share_a_point(const std::vector<GridPoint>& first,
                                        const GridTriangle& second)
{
    LinearSystem system(5);
    for (const GridPoint& corner : first)
    {
        system.add_column({corner[0], corner[1], corner[2], 1, 0});
    }
    for (const GridPoint& corner : second)
    {
        system.add_column({-corner[0], -corner[1], -corner[2], 0, 1});
    }
    system.set_right(3, 1);
    system.set_right(4, 1);
    return system.has_solution();
}

/// True if a box around the origin and a triangle share a point; the system has the slack to each
/// side.
[[nodiscard]] inline bool box_shares_a_point(const GridPoint& half, const GridTriangle& triangle)
{
    LinearSystem system(7);
    for (const GridPoint& corner : triangle)
    {
        system.add_column({corner[0], corner[1], corner[2], corner[0], corner[1], corner[2], 1});
    }
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        LinearSystem::Column to_upper{};
        LinearSystem::Column from_lower{};
        to_upper[axis] = 1;
        from_lower[3 + axis] = -1;
        system.add_column(to_upper);
        system.add_column(from_lower);
        system.set_right(axis, half[axis]);
        system.set_right(3 + axis, -half[axis]);
    }
    system.set_right(6, 1);
    return system.has_solution();
}

} // namespace tactus::test
