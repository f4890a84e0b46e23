" Settings of model files.
if exists("b:did_ftplugin")
  finish
endif
let b:did_ftplugin = 1

setlocal commentstring=#\ %s comments=:#
setlocal expandtab shiftwidth=2 softtabstop=2
setlocal iskeyword=@,48-57,_,192-255
" `gq` lays lines out as `maup fmt` does, `:make` lists the mistakes of the file.
if executable("maup")
  setlocal formatprg=maup\ fmt\ -
  setlocal makeprg=maup\ check\ %:S
  setlocal errorformat=%E--\ error\ %m\ -%#\ %f:%l:%c,%W--\ warning\ %m\ -%#\ %f:%l:%c,%-G%.%#
endif

let b:undo_ftplugin = "setlocal commentstring< comments< expandtab< shiftwidth< softtabstop<"
let b:undo_ftplugin .= " iskeyword< formatprg< makeprg< errorformat<"
