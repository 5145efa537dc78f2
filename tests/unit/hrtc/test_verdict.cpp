// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/report/verdict.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <string>

namespace tactus::hrtc::test
{
namespace
{

using Report = nlohmann::ordered_json;

/// Report of a run without faults.
Report good_report()
{
    return Report::parse(R"({
        "answers": {"exact": 40, "separated": 60, "within_tolerance": 0, "bounded": 0, "stale": 0},
        "budgets": {"frame_us": null, "splits": 64}, "scene": {"limited": 0},
        "pools": {"total_bytes": 2000000},
        "wire": {"server_lost": false},
        "deadline": {"overrun": 0, "stopped": 0},
        "realtime": {"allocations": 0, "system_calls_in_frame": 0}, "recording": null,
        "force": {"contact_share": 0.5, "data_limited_share": 0.125},
        "safety": {"supervisor_brakes": 0,
                   "begun": {"velocity": 0, "watchdog": 0, "software": 1, "disconnect": 0,
                             "stall": 0, "halted": 0}},
        "faults": {"split_budget_spent": 0, "forest_full": 0, "chunk_late": 0,
                   "surface_truncated": 0},
        "models": [{"name": "plate", "pieces_refused": 0, "pieces_overdue": 0,
                    "pieces_missing": 0}],
        "tools": [{"begins_inside": null, "least_stiffness_n_per_m": null}]})");
}

/// Verdict without the parts that are ok.
std::string verdict(const Report& report)
{
    std::string text = verdict_text(complaints_of(report));
    for (const std::string ok : {"mesh and scene: ok | ", "controller: ok | ", " | machine: ok"})
    {
        if (const std::size_t at = text.find(ok); at != std::string::npos)
        {
            text.erase(at, ok.size());
        }
    }
    return text;
}

bool fails_when_strict(const Report& report)
{
    return has_loss(complaints_of(report));
}

TEST(Verdict, is_ok_where_the_force_went_off_for_the_end_of_the_run_alone)
{
    EXPECT_EQ(verdict_text(complaints_of(good_report())), "ok");
}

TEST(Verdict, judges_mesh_and_scene_controller_and_machine_apart)
{
    Report report = good_report();
    report["safety"]["begun"]["stall"] = 26;
    report["safety"]["begun"]["watchdog"] = 1;
    report["safety"]["supervisor_brakes"] = 2;
    EXPECT_EQ(
        verdict_text(complaints_of(report)),
        "mesh and scene: ok | controller: ok | machine: the loop was woken late, and the force "
        "faded for a moment 27 times (2 brakes by the supervisor): 'hrtc doctor' lists the causes");
    EXPECT_TRUE(is_machine_alone(complaints_of(report)));
    EXPECT_FALSE(fails_when_strict(report));
    report["deadline"]["overrun"] = 1; // The loop itself may then be the cause.
    EXPECT_EQ(verdict(report), "controller: 1 deadline missed by an overrun of the loop; force "
                               "off, causes: watchdog 1, stall 26; 2 brakes by the supervisor");
    EXPECT_FALSE(is_machine_alone(complaints_of(report)));
    report = good_report();
    report["safety"]["begun"]["watchdog"] = 1; // The device was silent by itself.
    EXPECT_EQ(verdict(report), "controller: force off, causes: watchdog 1");
    report = good_report();
    report["deadline"]["stopped"] = 1;
    EXPECT_EQ(verdict(report),
              "machine: 1 deadline missed while the process was stopped from outside");
}

TEST(Verdict, names_losses_which_fail_a_strict_run)
{
    Report report = good_report();
    report["wire"]["server_lost"] = true;
    EXPECT_EQ(verdict(report), "mesh and scene: the server was lost");
    report["models"][0]["pieces_refused"] = 1;
    report["models"][0]["pieces_overdue"] = 8;
    report["models"][0]["pieces_missing"] = 5;
    report["scene"]["limited"] = 2;
    EXPECT_EQ(verdict(report),
              "mesh and scene: the server was lost; 1 damaged piece of plate; 8 pieces of plate "
              "did not arrive within 1 s, 5 never; 2 materials were limited");
    EXPECT_TRUE(fails_when_strict(report));
    report = good_report();
    report["safety"]["begun"]["disconnect"] = 4;
    EXPECT_EQ(verdict(report),
              "controller: force off, causes: disconnect 4; 4 device disconnections");
    EXPECT_TRUE(fails_when_strict(report));
    report = good_report();
    report["tools"][0]["least_stiffness_n_per_m"] = 0.5;
    EXPECT_EQ(verdict(report), "controller: tool 0: a stiffness of 0.5 N/m, too soft to feel");
    EXPECT_TRUE(fails_when_strict(report));
}

TEST(Verdict, is_never_good_without_one_exact_answer)
{
    Report report = good_report();
    report["answers"]["exact"] = 0;
    EXPECT_EQ(verdict(report), "ok"); // Nothing came near: separated.
    report["answers"]["bounded"] = 4'655;
    EXPECT_EQ(verdict(report), "mesh and scene: no answer was exact, 4655 were bounded");
    EXPECT_TRUE(fails_when_strict(report));
    report["answers"]["within_tolerance"] = 1;
    EXPECT_EQ(verdict(report), "ok");
    EXPECT_FALSE(fails_when_strict(report));
    report["answers"]["within_tolerance"] = 0;
    report["answers"]["exact"] = 1;
    EXPECT_EQ(verdict(report), "ok");
}

TEST(Verdict, says_why_nothing_was_touched)
{
    Report report = good_report();
    report["force"]["contact_share"] = 0.0;
    report["force"]["data_limited_share"] = 0.0;
    const std::string nothing = "mesh and scene: nothing was touched: ";
    EXPECT_EQ(verdict(report), nothing + "a tool came near, but the run ended before a contact");
    EXPECT_TRUE(fails_when_strict(report));
    report["force"]["data_limited_share"] = 0.1;
    EXPECT_EQ(verdict(report), nothing + "the tool was data-limited before it reached the surface");
    report["safety"]["begun"]["velocity"] = 2;
    EXPECT_EQ(verdict(report),
              nothing +
                  "the force was off, cause velocity | controller: force off, causes: velocity 2");
    report["answers"] = {
        {"exact", 0}, {"separated", 100}, {"within_tolerance", 0}, {"bounded", 0}, {"stale", 0}};
    report["safety"]["begun"]["velocity"] = 0;
    EXPECT_EQ(verdict(report),
              nothing + "no tool came near an object; the lines at the start give their positions");
    report["tools"][0]["begins_inside"] = "plate";
    EXPECT_EQ(verdict(report), "mesh and scene: tool 0 began inside plate, and the surface keeps "
                               "it inside; nothing was touched: the tool began inside");
}

TEST(Verdict, names_the_limit_that_held_the_tool_back_and_what_helps)
{
    Report report = good_report();
    report["force"]["data_limited_share"] = 0.86;
    EXPECT_EQ(verdict(report),
              "mesh and scene: data-limited for 86.0 % of the time: the surface at "
              "the tool wasn't known");
    report["faults"]["chunk_late"] = 7;
    report["faults"]["forest_full"] = 2'554;
    EXPECT_EQ(
        verdict(report),
        "mesh and scene: data-limited for 86.0 % of the time: no room for faces (forest_full in "
        "2554 frames): --pool-mib 8, 4 times as much");
    EXPECT_TRUE(fails_when_strict(report));
    report["force"]["data_limited_share"] = 0.0;
    report["safety"]["begun"]["halted"] = 2;
    report["faults"]["surface_truncated"] = 2'749;
    EXPECT_EQ(
        verdict(report),
        "mesh and scene: data-limited for 0.0 % of the time, and the force faded 2 times: more "
        "triangles are in reach of the tool than a frame can search (surface_truncated in 2749 "
        "frames): a smaller --tool, or a model with fewer faces; more memory does not help");
    EXPECT_TRUE(fails_when_strict(report));
    report["faults"]["split_budget_spent"] = 3'000;
    EXPECT_NE(verdict(report).find(
                  "(split_budget_spent in 3000 frames): --splits 256, the largest value"),
              std::string::npos);
    report["budgets"]["frame_us"] = 200.0;
    EXPECT_NE(verdict(report).find("): --splits 256, the largest value"), std::string::npos);
    report["budgets"]["splits"] = 256;
    EXPECT_NE(verdict(report).find("): --frame-budget-us above 200"), std::string::npos);
    report["faults"]["node_budget_spent"] = 4'000;
    EXPECT_NE(verdict(report).find("(node_budget_spent in 4000 frames): --frame-budget-us above "
                                   "200, a smaller --tool"),
              std::string::npos);
    report["budgets"]["frame_us"] = nullptr; // No limit: only another tool helps.
    EXPECT_NE(verdict(report).find("(node_budget_spent in 4000 frames): a smaller --tool"),
              std::string::npos);
}

} // namespace
} // namespace tactus::hrtc::test
