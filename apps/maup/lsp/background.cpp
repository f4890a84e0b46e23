#include "lsp/background.hpp"

#include <maupertuis/interrupt.hpp>
#include <maupertuis/language_services.hpp>

#include <exception>

namespace maupertuis::app::lsp {

Background::Background(std::chrono::milliseconds budget, std::function<void(Findings)> found)
    : budget_(budget), found_(std::move(found)) {
  worker_ = std::thread([this] { work(); });
  watcher_ = std::thread([this] { watch(); });
}

Background::~Background() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ends_ = unwanted_ = true;
    stop_ = true;
    waiting_.reset();
  }
  changed_.notify_all();
  worker_.join();
  watcher_.join();
}

void Background::begin(Task task) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!running_.empty()) stop_ = unwanted_ = true;
    waiting_ = std::move(task);
  }
  changed_.notify_all();
}

void Background::cancel(const std::string& uri) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (waiting_ && (uri.empty() || waiting_->uri == uri)) waiting_.reset();
  if (!running_.empty() && (uri.empty() || running_ == uri)) stop_ = unwanted_ = true;
}

void Background::work() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return ends_ || waiting_; });
    if (ends_) return;
    const Task task = *waiting_;
    waiting_.reset();
    running_ = task.uri;
    since_ = std::chrono::steady_clock::now();
    stop_ = unwanted_ = false;
    lock.unlock();
    changed_.notify_all();
    Findings findings{task.uri, task.version, std::nullopt};
    try {
      findings.diagnostics = language::diagnose_derivation(SourceText(task.uri, task.text), &stop_);
    } catch (const Interrupted&) {
    } catch (const std::exception& failure) {
      findings.diagnostics.emplace();
      findings.diagnostics->error("E0690", {}, "The equations could not be derived.", failure.what(),
                                  "This is a defect of maup, not of your model. Please report it.");
    }
    lock.lock();
    running_.clear();
    const bool wanted = !unwanted_;
    lock.unlock();
    if (wanted) found_(std::move(findings));
    lock.lock();
  }
}

/// Ends a task whose time is over.
void Background::watch() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!ends_) {
    if (running_.empty()) {
      changed_.wait(lock, [this] { return ends_ || !running_.empty(); });
      continue;
    }
    const auto end = since_ + budget_;
    if (changed_.wait_until(lock, end) == std::cv_status::timeout && !running_.empty() && since_ + budget_ <= end) {
      stop_ = true;
      changed_.wait(lock, [this, end] { return ends_ || running_.empty() || since_ + budget_ > end; });
    }
  }
}

}  // namespace maupertuis::app::lsp
