" Vim syntax file
" Language: Maupertuis model (.lag)
if exists("b:current_syntax")
  finish
endif

" Greek letters are word characters in any case.
syntax iskeyword @,48-57,_,192-255

syntax keyword lagFunction sin cos tan sec csc cot sinh cosh tanh sech asin acos atan atan2 asinh acosh atanh
syntax keyword lagFunction exp log erf lambert_w sqrt abs sign min max piecewise dot cross norm multiplier
syntax keyword lagWord name at in mass length stiffness coefficient inertia rotation restitution
syntax keyword lagWord static slip normal limit when rising falling within rel on from to by steps cells
syntax keyword lagWord rest angle axis until every exactly is not and or else where sticking with
syntax keyword lagWord action auto bottom box bracket charge circle class complex conserved
syntax keyword lagWord constraints contradiction current diag dirac disc dispersion double
syntax keyword lagWord eigenvalues ellipsoid energy equation equilibrium error euler first flux follow
syntax keyword lagWord for free freedoms frequencies full functions ground hamiltonian holonomic hoop
syntax keyword lagWord index integrable integral label left lost made motions multipliers natural nonholonomic
syntax keyword lagWord number of order over period periodic physical pivot quad quaternion record release
syntax keyword lagWord rheonomic right routhian rpy scleronomic second sequential set simultaneous solution
syntax keyword lagWord squared stable stick stiff stop taylor top total trace trail undecided unstable
syntax keyword lagWord variational wall
syntax keyword lagConstant pi t O

" These stand inside statements too.
syntax match lagWord /\<\(boundary\|constraint\|damper\|density\|event\|friction\|impact\|path\|spring\)\>/

" Statement words are reserved at the beginning of a line alone; those of energies stand before = there.
syntax match lagStatement /^\s*\zssystem\ze\k\@!/
syntax match lagStatement /^\s*\zssource\ze\k\@!/
syntax match lagStatement /^\s*\zsnote\ze\k\@!/
syntax match lagStatement /^\s*\zsdimensionless\ze\k\@!/
syntax match lagStatement /^\s*\zsparam\ze\k\@!/
syntax match lagStatement /^\s*\zscoord\ze\k\@!/
syntax match lagStatement /^\s*\zslet\ze\k\@!/
syntax match lagStatement /^\s*\zsinput\ze\k\@!/
syntax match lagStatement /^\s*\zsframe\ze\k\@!/
syntax match lagStatement /^\s*\zspoint\ze\k\@!/
syntax match lagStatement /^\s*\zsbody\ze\k\@!/
syntax match lagStatement /^\s*\zsgravity\ze\k\@!/
syntax match lagStatement /^\s*\zsspring\ze\k\@!/
syntax match lagStatement /^\s*\zsdamper\ze\k\@!/
syntax match lagStatement /^\s*\zstorsion\ze\k\@!/
syntax match lagStatement /^\s*\zskinetic\ze\k\@!/
syntax match lagStatement /^\s*\zspotential\ze\k\@!/
syntax match lagStatement /^\s*\zsgeneralized_potential\ze\k\@!/
syntax match lagStatement /^\s*\zslagrangian\ze\k\@!/
syntax match lagStatement /^\s*\zsdissipation\ze\k\@!/
syntax match lagStatement /^\s*\zsforce\ze\k\@!/
syntax match lagStatement /^\s*\zstorque\ze\k\@!/
syntax match lagStatement /^\s*\zsfriction\ze\k\@!/
syntax match lagStatement /^\s*\zsconstraint\ze\k\@!/
syntax match lagStatement /^\s*\zsgauge\ze\k\@!/
syntax match lagStatement /^\s*\zsreaction\ze\k\@!/
syntax match lagStatement /^\s*\zscontact\ze\k\@!/
syntax match lagStatement /^\s*\zsimpact\ze\k\@!/
syntax match lagStatement /^\s*\zsevent\ze\k\@!/
syntax match lagStatement /^\s*\zsstart\ze\k\@!/
syntax match lagStatement /^\s*\zsrun\ze\k\@!/
syntax match lagStatement /^\s*\zsoutput\ze\k\@!/
syntax match lagStatement /^\s*\zsmethod\ze\k\@!/
syntax match lagStatement /^\s*\zsprecision\ze\k\@!/
syntax match lagStatement /^\s*\zssweep\ze\k\@!/
syntax match lagStatement /^\s*\zsdraw\ze\k\@!/
syntax match lagStatement /^\s*\zsindependent\ze\k\@!/
syntax match lagStatement /^\s*\zspath\ze\k\@!/
syntax match lagStatement /^\s*\zsrates\ze\k\@!/
syntax match lagStatement /^\s*\zsfield\ze\k\@!/
syntax match lagStatement /^\s*\zsdensity\ze\k\@!/
syntax match lagStatement /^\s*\zsboundary\ze\k\@!/
syntax match lagStatement /^\s*\zsexpect\ze\k\@!/
syntax match lagStatement /^\s*\zsclaim\ze\k\@!/
syntax match lagStatement /^\s*\zs[TVULD]\ze\s*+\?=/

syntax match lagFunction /\<\(step\|reaction\)\ze(/
syntax match lagNumber /\<\d\+\(\.\d\+\)\?\([eE][-+]\?\d\+\)\?/
syntax match lagUnit /\[[^]]*\]/
syntax region lagString start=/"/ end=/"/ oneline
syntax match lagComment /#.*$/ contains=lagTodo
syntax keyword lagTodo contained TODO FIXME

highlight default link lagStatement Statement
highlight default link lagWord Keyword
highlight default link lagFunction Function
highlight default link lagConstant Constant
highlight default link lagNumber Number
highlight default link lagUnit Type
highlight default link lagString String
highlight default link lagComment Comment
highlight default link lagTodo Todo

let b:current_syntax = "lag"
