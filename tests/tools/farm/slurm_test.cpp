#include "tools/skerry/farm/slurm.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "engine/core/output.h"
#include "tests/folder.h"
#include "tests/tools/farm/one_line.h"
#include "tools/skerry/farm/programs.h"

namespace skerry::tools {
namespace {

namespace fs = std::filesystem;
using Jobs = std::vector<std::size_t>;

JobArray array_of(std::string command) {
  return {std::move(command), "/opt/skerry", "/data/set", "/home/me", 12, {1, 2, 3, 7}, {}};
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(JobRanges, JoinNeighbours) {
  EXPECT_EQ(job_ranges(Jobs{1, 2, 3, 7}), "1-3,7");
  EXPECT_EQ(job_ranges(Jobs{4}), "4");
  EXPECT_EQ(job_ranges(Jobs{1, 3, 4, 6}), "1,3-4,6");
  EXPECT_EQ(job_ranges(Jobs{}), "");
}

// `run I/N` takes the tasks I, I + N, ...: a job has to be that of the tasks its share holds.
TEST(JobOf, IsTheShareThatHoldsTheTask) {
  Plan plan;
  for (int i = 0; i < 10; ++i)
    plan.tasks.push_back({"t" + std::to_string(i), "task " + std::to_string(i)});
  for (std::size_t task = 0; task < plan.tasks.size(); ++task) {
    const std::vector<std::string> share{std::to_string(job_of(task, 4)) + "/4"};
    const Result<Jobs> chosen = chosen_tasks(plan, share);
    ASSERT_TRUE(chosen);
    EXPECT_NE(std::find(chosen->begin(), chosen->end(), task), chosen->end()) << task;
  }
}

TEST(ArrayScript, RunsSharesAgainAfterALostNode) {
  JobArray array = array_of("test");
  array.request = {"0:30:0", "gpu:1", "fast", "h100", 3};
  const std::string script = array_script(array);
  for (const char* part :
       {"#!/bin/sh\n", "#SBATCH --requeue\n", "#SBATCH --array=\"1-3,7\"\n",
        "#SBATCH --time=\"0:30:0\"\n", "#SBATCH --gres=\"gpu:1\"\n",
        "#SBATCH --partition=\"fast\"\n", "#SBATCH --constraint=\"h100\"\n",
        "#SBATCH --cpus-per-task=3\n", "#SBATCH --chdir=\"/home/me\"\n",
        "#SBATCH --output=\"/data/set/jobs/%A_%a.log\"\n",
        "exec '/opt/skerry' test run \"$SLURM_ARRAY_TASK_ID/12\" --dir '/data/set'\n"})
    EXPECT_TRUE(has(script, part)) << part << "in\n" << script;
  EXPECT_FALSE(has(script, "--exclusive"));
}

TEST(ArrayScript, AsksForNothingThatWasNotAskedFor) {
  const std::string script = array_script(array_of("stability"));
  for (const char* option : {"--time", "--gres", "--partition", "--constraint", "--exclusive"})
    EXPECT_FALSE(has(script, option)) << script;
}

TEST(ArrayScript, UsesWhatTheJobHas) {
  JobArray array = array_of("test");
  array.request.cpus = 5;
  EXPECT_TRUE(has(array_script(array), " --jobs 5\n"));
  for (const char* gres : {"gpu:4", "gpu:h100:4", "tmpdisk:1,gpu:2"}) {
    array.request.gres = gres;
    EXPECT_TRUE(has(array_script(array), " --devices all\n")) << gres;
    EXPECT_FALSE(has(array_script(array), "--jobs")) << gres;
  }
  for (const char* gres : {"gpu", "gpu:h100", "gpu:h100:1"}) {
    array.request.gres = gres;
    EXPECT_FALSE(has(array_script(array), "--devices")) << gres;
  }
}

TEST(ArrayScript, QuotesNames) {
  JobArray array = array_of("test");
  array.dir = "/a 'b' \"c\" 100%A \\d";
  const std::string script = array_script(array);
  EXPECT_TRUE(has(script, "--dir '/a '\\''b'\\'' \"c\" 100%A \\d'")) << script;
  EXPECT_TRUE(has(script, "--output=\"/a 'b' \\\"c\\\" 100%%A \\\\d/jobs/%A_%a.log\"")) << script;
}

// What the shell makes of the last line.
TEST(ArrayScript, HandsNamesOnAsTheyAre) {
  const Folder folder;
  JobArray array = array_of("test");
  array.program = "/bin/echo";
  array.dir = "/a 'b' \"c\" $HOME `x` \\d";
  const fs::path file = folder.path() / "script";
  ASSERT_TRUE(write_text(file, array_script(array)));
  const Result<ProgramEnd> end = run_program({"env", "SLURM_ARRAY_TASK_ID=7", "sh", file.string()});
  ASSERT_TRUE(end);
  EXPECT_EQ(end->out, "test run 7/12 --dir /a 'b' \"c\" $HOME `x` \\d --jobs 1\n") << end->err;
}

TEST(ArrayScript, GivesTimedTasksWholeNodesOfOneKind) {
  JobArray array = array_of("report");
  EXPECT_TRUE(has(array_script(array), "#SBATCH --exclusive\n"));
  EXPECT_NE(fault_of({}, "report"), "");
  EXPECT_EQ(fault_of({"", "", "", "h100", 1}, "report"), "");
  EXPECT_EQ(fault_of({"", "", "fast", "", 1}, "report"), "");
  EXPECT_EQ(fault_of({}, "test"), "");
  EXPECT_NE(fault_of({"", "gpu:2", "", "", 1}, "stability"), "");
  EXPECT_NE(fault_of({"1\n#SBATCH --uid=0", "", "", "", 1}, "test"), "");
}

TEST(MergeScript, WritesEachCommandsOutputsToItsFolder) {
  EXPECT_TRUE(has(merge_script(array_of("test")),
                  "exec '/opt/skerry' 'test' 'merge' '--dir' '/data/set' '--json' "
                  "'/data/set/rows.json' '--html' '/data/set/page' '--junit' "
                  "'/data/set/rows.xml'\n"));
  EXPECT_TRUE(has(merge_script(array_of("report")), "'--out' '/data/set/page'\n"));
  EXPECT_TRUE(has(merge_script(array_of("stability")), "'--json' '/data/set/rows.json'\n"));
  EXPECT_FALSE(has(merge_script(array_of("report")), "--array"));
}

TEST(Queue, HasTheJobsOfTheArrayAlone) {
  const Submitted submitted{"17", "18", 12, {1, 2, 3}};
  const Queue queue = queue_from(
      "17 1 R\n17 2 PD\n16 3 R\n17 3 CG\n17 4 CF\n170 5 R\n18 N/A PD\n17 N/A PD\n", submitted);
  EXPECT_EQ(queue.running, (Jobs{1, 3}));
  EXPECT_EQ(queue.waiting, (Jobs{2, 4}));
  EXPECT_TRUE(queue.merge);
  EXPECT_FALSE(queue_from("16 1 R\n", submitted).merge);
}

TEST(SubmittedFile, ComesBackAsItWasOrIsRefused) {
  const Folder folder;
  Result<Submitted> none = read_submitted(folder.path());
  ASSERT_TRUE(none);
  EXPECT_EQ(none->array, "");
  fs::create_directories(jobs_dir(folder.path()));
  ASSERT_TRUE(write_submitted(folder.path(), {"17", "18", 12, {1, 2, 7}}));
  const Result<Submitted> read = read_submitted(folder.path());
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->array, "17");
  EXPECT_EQ(read->merge, "18");
  EXPECT_EQ(read->count, 12u);
  EXPECT_EQ(read->jobs, (Jobs{1, 2, 7}));
  for (const char* damaged : {"", "{", "[]", R"({"array":"1","merge":"","count":0,"jobs":[]})",
                              R"({"array":"1","merge":"","count":-1,"jobs":[]})",
                              R"({"array":1,"merge":"","count":1,"jobs":[]})"}) {
    ASSERT_TRUE(write_text(jobs_dir(folder.path()) / "submitted.json", damaged));
    expect_one_line(read_submitted(folder.path()), {"submitted.json", "delete the file"});
  }
}

TEST(RunProgram, GivesOutputsAndStatus) {
  const Result<ProgramEnd> end =
      run_program({"sh", "-c", "echo out; echo a >&2; echo b >&2; exit 5"});
  ASSERT_TRUE(end);
  EXPECT_EQ(end->status, 5);
  EXPECT_EQ(end->out, "out\n");
  EXPECT_EQ(last_line(end->err), "b");
  const Result<ProgramEnd> killed = run_program({"sh", "-c", "kill -9 $$"});
  ASSERT_TRUE(killed);
  EXPECT_EQ(killed->status, 128 + 9);
  expect_one_line(run_program({"no such program"}), {"no such program"});
}

TEST(LastLine, LeavesOutEmptyOnes) {
  EXPECT_EQ(last_line("a\nb\n\n"), "b");
  EXPECT_EQ(last_line("a"), "a");
  EXPECT_EQ(last_line("\n"), "");
}

}  // namespace
}  // namespace skerry::tools
