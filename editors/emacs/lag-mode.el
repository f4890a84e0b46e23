;;; lag-mode.el --- Models of Maupertuis  -*- lexical-binding: t; coding: utf-8 -*-

;; Package-Requires: ((emacs "26.1"))

;;; Commentary:
;; Highlighting of model files (.lag), and `maup lsp' for Eglot.
;; (add-to-list 'load-path "…/editors/emacs") (require 'lag-mode)
;; (add-hook 'lag-mode-hook #'eglot-ensure)

;;; Code:

(defconst lag-statement-words
  '("system" "source" "note" "dimensionless" "param" "coord" "let" "input" "frame" "point" "body" "gravity"
    "spring" "damper" "torsion" "kinetic" "potential" "generalized_potential" "lagrangian"
    "dissipation" "force" "torque" "friction" "constraint" "gauge" "reaction" "contact" "impact"
    "event" "start" "run" "output" "method" "precision" "sweep" "draw" "independent" "path" "rates"
    "field" "density" "boundary" "expect" "claim")
  "Words that begin a statement at the beginning of a line.")

(defconst lag-energy-words
  '("T" "V" "U" "L" "D")
  "Energies: they begin a statement before an equals sign.")

(defconst lag-words
  '("name" "at" "in" "mass" "length" "stiffness" "coefficient" "inertia" "rotation" "restitution"
    "friction" "static" "slip" "normal" "limit" "when" "rising" "falling" "within" "rel" "on" "from"
    "to" "by" "steps" "cells" "boundary" "rest" "angle" "axis" "until" "every" "exactly" "is" "not"
    "and" "or" "else" "where" "sticking" "with" "action" "auto" "bottom" "box" "bracket" "charge"
    "circle" "class" "complex" "conserved" "constraint" "constraints" "contradiction" "current"
    "damper" "density" "diag" "dirac" "disc" "dispersion" "double" "eigenvalues" "ellipsoid" "energy"
    "equation" "equilibrium" "error" "euler" "event" "first" "flux" "follow" "for" "free" "freedoms"
    "frequencies" "full" "functions" "ground" "hamiltonian" "holonomic" "hoop" "impact" "index"
    "integrable" "integral" "label" "left" "lost" "made" "motions" "multipliers" "natural"
    "nonholonomic" "number" "of" "order" "over" "path" "period" "periodic" "physical" "pivot" "quad"
    "quaternion" "record" "release" "rheonomic" "right" "routhian" "rpy" "scleronomic" "second"
    "sequential" "set" "simultaneous" "solution" "spring" "squared" "stable" "stick" "stiff" "stop"
    "taylor" "top" "total" "trace" "trail" "undecided" "unstable" "variational" "wall")
  "Words inside statements.")

(defconst lag-functions
  '("sin" "cos" "tan" "sec" "csc" "cot" "sinh" "cosh" "tanh" "sech" "asin" "acos" "atan" "atan2"
    "asinh" "acosh" "atanh" "exp" "log" "erf" "lambert_w" "sqrt" "abs" "sign" "min" "max" "step"
    "piecewise" "dot" "cross" "norm" "multiplier" "reaction")
  "Functions.")

(defconst lag-font-lock-keywords
  `((,(concat "^[ \t]*" (regexp-opt lag-statement-words t) "\\_>") 1 font-lock-keyword-face)
    (,(concat "^[ \t]*" (regexp-opt lag-energy-words t) "[ \t]*\\+?=") 1 font-lock-keyword-face)
    ("\\[[^]\n]*\\]" . font-lock-type-face)
    (,(regexp-opt lag-functions 'symbols) . font-lock-function-name-face)
    (,(regexp-opt lag-words 'symbols) . font-lock-builtin-face)
    ("\\_<[0-9]+\\(?:\\.[0-9]+\\)?\\(?:[eE][-+]?[0-9]+\\)?" . font-lock-constant-face))
  "What is highlighted in a model.")

(defvar lag-mode-syntax-table
  (let ((table (make-syntax-table)))
    (modify-syntax-entry ?# "<" table)
    (modify-syntax-entry ?\n ">" table)
    (modify-syntax-entry ?\" "\"" table)
    (modify-syntax-entry ?_ "_" table)
    (dolist (sign '(?' ?+ ?- ?* ?/ ?^ ?= ?< ?> ?& ?% ?|))
      (modify-syntax-entry sign "." table))
    table)
  "Comments begin with #, texts stand between quotes, primes and operators are signs.")

;;;###autoload
(define-derived-mode lag-mode prog-mode "Lag"
  "Models of Maupertuis."
  (setq-local comment-start "# ")
  (setq-local comment-end "")
  (setq-local comment-start-skip "#+[ \t]*")
  (setq-local indent-line-function #'indent-relative)
  (setq-local compile-command
              (concat "maup check " (shell-quote-argument (or buffer-file-name ""))))
  (setq-local font-lock-defaults '(lag-font-lock-keywords)))

;;;###autoload
(add-to-list 'auto-mode-alist '("\\.lag\\'" . lag-mode))

(defvar eglot-server-programs)
(with-eval-after-load 'eglot
  (add-to-list 'eglot-server-programs '(lag-mode . ("maup" "lsp"))))

(provide 'lag-mode)
;;; lag-mode.el ends here
