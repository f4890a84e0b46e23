#pragma once
// What the C++ of the documents takes for granted: the results of earlier stages, and what a reader does with numbers.
#include <maupertuis/ensemble.hpp>
#include <maupertuis/ensemble_through_modes.hpp>
#include <maupertuis/equations_of_motion.hpp>
#include <maupertuis/language_services.hpp>
#include <maupertuis/mechanical_system.hpp>
#include <maupertuis/motion_kernel.hpp>

#include <string>
#include <vector>

extern const maupertuis::EquationsOfMotion& equations;
extern const maupertuis::Model& model;
extern const maupertuis::EnsembleStart& start;
extern maupertuis::Diagnostics& diagnostics;
extern const std::vector<double> q0, v0;
extern std::string text;

template <class... Values>
void report(const Values&...) {}
template <class... Values>
void use(const Values&...) {}
