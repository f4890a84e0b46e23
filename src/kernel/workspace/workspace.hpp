#pragma once
#include "kernel/reference/point_section.hpp"
#include "kernel/workspace/along_section.hpp"
#include "kernel/workspace/code_tiers.hpp"
#include "kernel/workspace/stage_solver.hpp"

namespace maupertuis {

/// What is expanded, the code for it, and what solves its stages. Stages run in workspace.cpp; what is read of them, in
/// workspace_values.cpp.
struct KernelWorkspace::Impl {
  Impl(const Kernel& kernel, int order);

  bool outputs_follow_accelerations() const;
  KernelStatus run(double t, std::span<const double> q, std::span<const double> v, int stages);
  bool run_unrolled(std::span<const double> q, std::span<const double> v, int stages);
  void run_first_stages(double unknowns);
  KernelStatus without_solution(KernelStatus status);
  KernelStatus run_step_by_step(int stage);
  bool runs_on() const;
  bool run_later_stages(int stages);
  void run_stage(int stage);
  void renew_blocks(int stage, int stages);
  void run_along(int stage);
  void observe();
  void adopt(workspace::ExpansionCode code);

  workspace::Expansion expansion;
  workspace::ExpansionInCode in_code;
  workspace::StageSolver solver;
  workspace::AlongSection along;
  reference::PointSection at_point;
  bool corrects_points;  // something that is read at a point alone depends on q̈
  bool points_are_unrolled;
  bool observed = true;  // observables have the values of the last point
  workspace::CodeTiers tiers;
};

}  // namespace maupertuis
