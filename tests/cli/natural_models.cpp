// Natural models that ended commands with a signal once.
#include "json.hpp"

#include <doctest/doctest.h>

using namespace cli_test;

TEST_CASE("action: free ends of which constraints leave nothing") {
  const Folder folder;
  const std::string model = folder.write("ends.lag",
                                         "system ends\ndimensionless\ncoord x, y : number\nL = x'^2/2 + y'^2/2\nconstraint y = 1\n"
                                         "path from (0, free) at 0 to (1, free) at 1\n");
  const Outcome run = shell("timeout 60 \"$MAUP\" action " + model);
  CHECK(run.code == 0);
  CHECK(run.out.find("a minimum of S (index 0)") != std::string::npos);
}

TEST_CASE("report: a constraint that is not linear in velocities, and an integral that is expected") {
  const Folder folder;
  const std::string model = folder.write("speed.lag",
                                         "system speed\ndimensionless\nparam m = 1\ncoord x, y : number\npoint P mass m at (x, y)\n"
                                         "constraint x'^2 + y'^2 = 1\nstart x' = 0.6, y' = 0.8\nrun 1\nexpect integral x' - y'\n");
  const Outcome run = shell("timeout 60 \"$MAUP\" report " + model + " -o " + folder.path("speed.html"));
  CHECK(run.code == 0);
}

TEST_CASE("invariants: a robot whose frames hold derivatives") {
  const Outcome run = shell("timeout 200 \"$MAUP\" invariants " PROJECT_DIR "/tests/problems/urdf_panda.lag");
  CHECK(run.code == 0);
}
