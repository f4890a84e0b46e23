#pragma once
#include <maupertuis/report.hpp>

#include <string>

/// The parts of the page, in its order. Each is empty where the content has nothing for it.
namespace maupertuis {

/// A paragraph each.
std::string notes_html(const std::vector<std::string>& notes);
std::string messages_section(const ReportContent& content);
std::string drawing_section(const ReportContent& content);
std::string equations_section(const ReportContent& content);
std::string model_section(const ReportContent& content);
std::string derivation_section(const ReportContent& content);
std::string phase_space_section(const ReportContent& content);
std::string certificate_section(const ReportContent& content);
std::string conserved_section(const ReportContent& content);
std::string motion_section(const ReportContent& content);
std::string modes_section(const ReportContent& content);
std::string orbits_section(const ReportContent& content);
std::string paths_section(const ReportContent& content);
/// Figures beside each other.
std::string diagrams_html(const std::vector<ReportContent::Locus>& diagrams);
std::string expectations_section(const ReportContent& content);

}  // namespace maupertuis
