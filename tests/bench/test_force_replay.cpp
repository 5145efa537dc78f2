// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/mesh/write_mesh.hpp"
#include "host_tools/shapes/shapes.hpp"
#include "platform/allocation_counter.hpp"
#include "tests/bench/bumpy_sphere.hpp"
#include "tests/bench/force_replay.hpp"
#include "tests/bench/force_trajectory.hpp"
#include "tests/shared/temporary_folder.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

namespace tactus::bench
{

namespace
{

NamedMesh round_mesh()
{
    return {"round-1280", make_shape(Shape::sphere, 1'280).value()};
}

/// A device that presses on the sphere from above and holds still.
ForceRun press(const Scene& scene)
{
    ForceRun run{scene, {}, {}};
    run.tool.radius_m = 5e-3;
    run.tool.stiffness_n_per_m = 100.0;
    run.tool.force_max_n = 100.0;
    for (int i = 0; i < 300; ++i)
    {
        const double height_m = 0.058 - 5e-3 * std::min(1.0, i / 200.0);
        run.goals_m.emplace_back(Vec3(0.0, 0.0, height_m) - Vec3(scene.model.origin_m.data()));
    }
    run.lead_in = 250;
    return run;
}

TEST(ForceReplay, the_force_is_the_spring_s_and_replays_agree)
{
    SceneStore scenes("");
    const Scene& scene = *scenes.get(round_mesh()).value();

    const auto sut = replay_forces(press(scene), 2);

    ASSERT_TRUE(sut);
    ASSERT_EQ(sut.value().outputs.size(), 50U);
    for (const ToolOutput& output : sut.value().outputs)
    {
        EXPECT_TRUE(output.in_contact);
        // 2 mm below where the ball rests; the mesh is up to 0.2 mm inside of the sphere.
        EXPECT_NEAR(output.force_n.norm(), 0.2, 0.025);
        EXPECT_GT(output.force_n.z(), 0.17);
    }
    for (const double us : sut.value().frame_us.least())
    {
        EXPECT_TRUE(std::isfinite(us));
    }
    EXPECT_EQ(sut.value().allocations.has_value(), allocation_counter::available());
    EXPECT_EQ(sut.value().allocations.value_or(0), 0U);
}

TEST(ForceReplay, another_way_has_another_hash)
{
    SceneStore scenes("");
    const Scene& scene = *scenes.get(round_mesh()).value();
    ForceRun other = press(scene);
    other.goals_m.back().x() += 1e-9;

    EXPECT_NE(replay_forces(press(scene), 1).value().hash, replay_forces(other, 1).value().hash);
}

TEST(ForceTrajectory, a_sample_is_a_frame_and_gaps_are_periods)
{
    SceneStore scenes("");
    const Scene& scene = *scenes.get(round_mesh()).value();
    Trajectory trajectory;
    for (const double time_s : {1.0, 1.002, 1.004, 1.0141, 1.0145})
    {
        trajectory.samples.push_back({time_s, Vec3(time_s, 0.0, 0.0), Vec3(0.0, 0.0, 0.0)});
    }
    const ForceRun sut = make_trajectory_run(scene, trajectory, 1e-3, 250.0);

    EXPECT_EQ(sut.period_ns, 2'000'000);
    EXPECT_EQ(sut.elapsed_periods, (std::vector<std::uint32_t>{1, 1, 1, 5, 1}));
    EXPECT_NEAR(sut.tool.speed_max_m_per_s, 1.5, 1e-9);
    EXPECT_EQ(sut.tool.stiffness_n_per_m, 250.0);
    ASSERT_EQ(sut.goals_m.size(), 5U);
    EXPECT_EQ(sut.goals_m[3].x(), 1.0141 - scene.model.origin_m[0]);
}

TEST(ForceTrajectory, compares_vectors_or_where_only_those_are_known_amounts)
{
    std::vector<ToolOutput> outputs(2);
    outputs[0].force_n = Vec3(0.0, 3.0, 0.0);
    outputs[1].force_n = Vec3(0.0, 0.0, 1.0);
    Trajectory trajectory;
    trajectory.samples = {{1.0, Vec3(0.0, 0.0, 0.0), Vec3(4.0, 0.0, 0.0)},
                          {2.0, Vec3(0.0, 0.0, 0.0), Vec3(1.0, 0.0, 0.0)}};

    const ForceDifference vectors = compare_forces(outputs, trajectory);
    EXPECT_NEAR(vectors.max_n, 5.0, 1e-12);
    EXPECT_EQ(vectors.max_time_s, 1.0);
    EXPECT_NEAR(vectors.rms_n, std::sqrt(13.5), 1e-12);

    trajectory.has_force_direction = false;
    const ForceDifference amounts = compare_forces(outputs, trajectory);
    EXPECT_NEAR(amounts.max_n, 1.0, 1e-12);
    EXPECT_NEAR(amounts.rms_n, std::sqrt(0.5), 1e-12);
}

double value_of(const Rows& rows, const std::string& metric)
{
    for (const Row& row : rows)
    {
        if (row.metric == metric)
        {
            return row.value;
        }
    }
    return std::nan("");
}

/// A recording of the analytic surface's forces on a slow press, and a mesh of it: what comes out
/// is the mesh's own error.
TEST(ForceTrajectory, a_recording_of_the_true_forces_is_met_within_the_mesh_s_error)
{
    const test::TemporaryFolder folder("force-trajectory");
    const TriangleMesh mesh = make_shape(Shape::bumpy_sphere, 5'120).value();
    BenchOptions options;
    options.trajectory.mesh = folder.path() / "bumpy.ply";
    ASSERT_TRUE(write_mesh(options.trajectory.mesh, mesh));
    options.trajectory.mesh_unit = "m";
    options.trajectory.file = folder.path() / "press.traj";
    options.trajectory.proxy_radius_mm = 2.0;
    {
        const SurfaceFoot foot = bumpy_foot(Vec3(0.03, 0.02, 0.04));
        std::ofstream file(options.trajectory.file);
        file << "a press, mm and N\n";
        for (int i = 0; i <= 400; ++i)
        {
            const double height_m = 3e-3 - 2e-3 * std::min(1.0, i / 300.0);
            const Vec3 device = foot.point_m + height_m * foot.normal;
            const Vec3 force_n = bumpy_force_n(device, 2e-3, 500.0);
            const Vec3 device_mm = 1e3 * device;
            file << fmt::format("{} {} {} {} {} {} {}\r\n", 0.001 * i, device_mm.x(), device_mm.y(),
                                device_mm.z(), force_n.x(), force_n.y(), force_n.z());
        }
    }
    Rows rows;
    ASSERT_EQ(compare_trajectory(options, rows), std::nullopt);

    EXPECT_EQ(value_of(rows, "samples"), 401.0);
    EXPECT_NEAR(value_of(rows, "duration"), 0.4, 1e-12);
    EXPECT_GT(value_of(rows, "recorded force, RMS"), 0.3);
    EXPECT_LT(value_of(rows, "force error, max"), 0.15);
    EXPECT_LE(value_of(rows, "force error, RMS"), value_of(rows, "force error, max"));

    options.trajectory.columns = "t,x,y,z,-fx,-fy,-fz";
    rows.clear();
    ASSERT_EQ(compare_trajectory(options, rows), std::nullopt);
    EXPECT_GT(value_of(rows, "force error, max"), 0.8);
}

TEST(ForceTrajectory, says_which_file_can_t_be_used)
{
    const test::TemporaryFolder folder("force-trajectory-bad");
    BenchOptions options;
    options.trajectory.file = folder.path() / "none.traj";
    options.trajectory.mesh = folder.path() / "none.ply";
    Rows rows;
    EXPECT_EQ(compare_trajectory(options, rows),
              options.trajectory.file.string() + ": no such file");
    std::ofstream(options.trajectory.file) << "0 0 0 0 0 0 0\n1 0 0 0 0 0 0\n";
    EXPECT_EQ(compare_trajectory(options, rows),
              options.trajectory.mesh.string() + ": no such file");
    EXPECT_TRUE(rows.empty());
}

} // namespace

} // namespace tactus::bench
